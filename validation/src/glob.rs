//! Patterns of ids.

/// Whether a text fits a pattern in which `*` stands for any characters.
pub(crate) fn matches(pattern: &str, text: &str) -> bool {
    let Some((head, rest)) = pattern.split_once('*') else { return pattern == text };
    let Some(text) = text.strip_prefix(head) else { return false };
    if rest.is_empty() {
        return true;
    }
    (0..=text.len()).filter(|i| text.is_char_boundary(*i)).any(|i| matches(rest, &text[i..]))
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn a_star_stands_for_any_characters() {
        assert!(matches("a.b", "a.b") && !matches("a.b", "a.bc"));
        assert!(matches("a.*", "a.b.c") && !matches("a.*", "b.a."));
        assert!(matches("a.*.four", "a.x.y.four") && !matches("a.*.four", "a.x.y.five"));
        assert!(matches("*.x.*", "a.x.b.x."));
    }
}
