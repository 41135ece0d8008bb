//! What a verdict means, in sentences that stand alone.

use validation::Status;

use super::RecordedOutput;

impl RecordedOutput {
    /// Program and version.
    pub(super) fn program(&self) -> String {
        let program = self.about.program.as_deref().unwrap_or("results");
        match &self.about.version {
            Some(version) => format!("{program} {version}"),
            None => program.to_owned(),
        }
    }

    /// Counts of the verdict.
    pub(super) fn counts(&self) -> String {
        let verdict = &self.verdict;
        let (passed, missed, failed) = (verdict.passed, verdict.missed, verdict.failed);
        let other = verdict.of_another_kind;
        format!("{passed} passed, {missed} missed, {failed} failed, {other} of another kind")
    }

    /// What the counts mean.
    pub(super) fn meaning(&self) -> String {
        let verdict = &self.verdict;
        let judged = verdict.passed + verdict.missed + verdict.failed;
        let kind = self.about.kind.name();
        let mut sentences = vec![match (verdict.failed, verdict.missed) {
            (0, _) if judged == 0 => format!(
                "Nothing was judged: no reference that could be asked is of kind {kind}. The results stand beside \
                 references of other kinds, which neither confirm nor refute them."
            ),
            (0, 0) if judged == 1 => {
                "The one judged check agrees with its reference within the stated tolerance."
                    .to_owned()
            }
            (0, 0) => format!(
                "All {judged} judged checks agree with their references within the stated tolerances."
            ),
            (0, missed) => format!(
                "{} of {} with {} within the stated tolerances; {missed} {}.",
                verdict.passed,
                agree(verdict.passed, "agree", judged),
                if verdict.passed == 1 { "its reference" } else { "their references" },
                if missed == 1 { "is a listed miss" } else { "are listed misses" }
            ),
            (failed, _) => format!(
                "{failed} of {} with a reference of kind {kind} by more than the stated tolerance: these results are not \
                 those of the scenes that they are named after.",
                agree(failed, "disagree", judged)
            ),
        }];
        if verdict.missed > 0 {
            sentences.push(
                "A listed miss is a reference that sound models are known not to meet, with its analysis in \
                 checks/misses.toml of epicyclic or among the misses that the author accepts."
                    .to_owned(),
            );
        }
        if verdict.of_another_kind > 0 {
            sentences.push(
                "Checks of another kind of model are shown beside their references and not judged."
                    .to_owned(),
            );
        }
        if !self.about.only.is_empty() {
            sentences.push(format!(
                "Only checks whose ids start with {} were asked for.",
                self.about.only.join(" or ")
            ));
        }
        if !verdict.not_asked.is_empty() {
            sentences.push("What was not asked is not confirmed.".to_owned());
        }
        sentences.join(" ")
    }

    /// Ids of the checks of a status.
    pub(super) fn ids(&self, status: Status) -> impl Iterator<Item = &str> {
        self.verdict.checks.iter().filter(move |c| c.status == status).map(|c| c.id.as_str())
    }
}

/// `19 judged checks disagree`, of one of them `19 judged checks disagrees`.
fn agree(count: usize, verb: &str, judged: usize) -> String {
    let checks = if judged == 1 { "check" } else { "checks" };
    let end = if count == 1 { "s" } else { "" };
    format!("{judged} judged {checks} {verb}{end}")
}
