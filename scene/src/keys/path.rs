//! Dotted paths of keys.

/// Whether `key` is `table` or a key below it.
pub(crate) fn is_within(key: &str, table: &str) -> bool {
    key.strip_prefix(table).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The path without the numbers that tell tables of an array apart, which their headers do not have.
pub(crate) fn without_indices(key: &str) -> String {
    let steps = key.split('.').filter(|step| step.parse::<usize>().is_err());
    steps.collect::<Vec<_>>().join(".")
}
