//! The name that a misspelt one was probably meant to be.

/// The name nearest to `given`, if about two of three letters agree.
pub(crate) fn nearest<'n>(
    given: &str,
    names: impl IntoIterator<Item = &'n str>,
) -> Option<&'n str> {
    let given = given.to_lowercase();
    let distance = |name: &&str| strsim::levenshtein(&name.to_lowercase(), &given);
    let found = names.into_iter().min_by_key(distance)?;
    (distance(&found) <= 1 + given.chars().count() / 3).then_some(found)
}

/// The same as the end of a sentence, nothing if no name is near.
pub(crate) fn did_you_mean<'n>(given: &str, names: impl IntoIterator<Item = &'n str>) -> String {
    nearest(given, names).map_or(String::new(), |name| format!("; did you mean `{name}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_pen_is_recognised_and_another_word_is_not() {
        let names = ["frequency_hz", "mode_type"];
        assert_eq!(nearest("Frequenzy_hz", names), Some("frequency_hz"));
        assert_eq!(nearest("temperature", names), None);
        assert_eq!(did_you_mean("mode_typ", names), "; did you mean `mode_type`?");
        assert_eq!(did_you_mean("x", []), "");
    }
}
