//! Text of at most a hundred columns.

/// Columns of text for people, at most.
pub(crate) const WIDTH: usize = 100;

/// Lines of text, those that are too long broken between words and indented where they go on.
pub(crate) fn wrapped(text: &str) -> String {
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

fn line(line: &str) -> String {
    if textwrap::core::display_width(line) <= WIDTH {
        return line.to_owned();
    }
    let indent = &line[..line.len() - line.trim_start().len()];
    paragraph(line.trim_start(), indent, &format!("{indent}  "))
}

/// Lines of at most [`WIDTH`] columns, the first and the further ones behind an indent.
pub(crate) fn paragraph(text: &str, first: &str, further: &str) -> String {
    let options = textwrap::Options::new(WIDTH)
        .initial_indent(first)
        .subsequent_indent(further)
        .word_separator(textwrap::WordSeparator::AsciiSpace)
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    textwrap::fill(text, options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_go_on_below_their_beginning() {
        let text = format!("  {}\nshort", "word ".repeat(30).trim_end());
        let shown = wrapped(&text);
        let lines: Vec<&str> = shown.lines().collect();
        assert_eq!(lines.len(), 3, "{shown}");
        assert!(lines[0].starts_with("  word") && lines[1].starts_with("    word"), "{shown}");
        assert!(lines.iter().all(|line| line.chars().count() <= WIDTH), "{shown}");
        let words = |text: &str| text.split_whitespace().count();
        assert_eq!(words(&shown), words(&text));
    }
}
