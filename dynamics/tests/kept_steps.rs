//! Branches that are interrupted at every step and gone on with.

use std::cell::RefCell;
use std::collections::BTreeMap;

use dynamics::continuation::{
    Branch, ContinuationError, ContinuationOptions, Direction, End, Evaluation, Family, Judgement,
    KeptStep, Scales, StepStore, Unkept, branch_off, trace_both,
};
use nalgebra::{DMatrix, DVector};

#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("interrupted")]
struct Interrupted;

/// Value and derivatives by y and λ.
type Equation = fn(f64, f64) -> [f64; 3];

/// An equation of one unknown that counts its evaluations; its test function is its derivative by y.
struct Counted {
    equation: Equation,
    evaluations: usize,
}

impl Family for Counted {
    type Error = Interrupted;

    fn dimension(&self) -> usize {
        1
    }

    fn evaluate(&mut self, y: &[f64], lambda: f64) -> Result<Evaluation, Interrupted> {
        self.evaluations += 1;
        let [f, by_y, by_lambda] = (self.equation)(y[0], lambda);
        Ok(Evaluation {
            residual: DVector::from_element(1, f),
            jacobian: DMatrix::from_element(1, 1, by_y),
            derivative: DVector::from_element(1, by_lambda),
        })
    }

    fn judge(&mut self, y: &[f64], lambda: f64) -> Result<Judgement, Interrupted> {
        self.evaluations += 1;
        let [_, slope, _] = (self.equation)(y[0], lambda);
        Ok(Judgement { is_stable: Some(slope < 0.0), tests: vec![slope] })
    }
}

/// Steps in memory; writing one fails after so many.
struct Steps<'s> {
    kept: &'s RefCell<BTreeMap<(bool, usize), KeptStep>>,
    most: usize,
}

impl StepStore<Counted> for Steps<'_> {
    fn load(&mut self, way: Direction, number: usize) -> Result<Option<KeptStep>, Interrupted> {
        Ok(self.kept.borrow().get(&(way == Direction::Up, number)).cloned())
    }

    fn save(
        &mut self,
        _: &mut Counted,
        way: Direction,
        number: usize,
        step: &KeptStep,
    ) -> Result<(), Interrupted> {
        if self.most == 0 {
            return Err(Interrupted);
        }
        self.most -= 1;
        let before = self.kept.borrow_mut().insert((way == Direction::Up, number), step.clone());
        assert!(before.is_none(), "a step was taken twice");
        Ok(())
    }
}

/// Follows with a store that fails after every step, again and again, until the branch is complete; then once more.
/// Returns the branch, the number of interruptions, and evaluations of the last two runs.
fn interrupted(
    equation: Equation,
    follow: impl Fn(
        &mut Counted,
        &mut Steps<'_>,
    ) -> Result<Branch<Interrupted>, ContinuationError<Interrupted>>,
) -> (Branch<Interrupted>, usize, [usize; 2]) {
    let kept = RefCell::new(BTreeMap::new());
    let mut interruptions = 0;
    let run = |most| {
        let mut family = Counted { equation, evaluations: 0 };
        let found = follow(&mut family, &mut Steps { kept: &kept, most });
        (found, family.evaluations)
    };
    loop {
        let (found, last) = run(1);
        match found {
            Ok(found) => {
                // All steps are there: nothing may be written.
                let (again, evaluations) = run(0);
                assert_eq!(again.unwrap(), found);
                return (found, interruptions, [last, evaluations]);
            }
            Err(ContinuationError::Family { cause: Interrupted, .. }) => interruptions += 1,
            Err(other) => panic!("{other}"),
        }
    }
}

/// λ = y³ − y with two folds between its bounds, and a circle, which closes: the branch that was interrupted after each
/// of its steps has the points of one that was not, to the last bit, and what is finished is not evaluated again.
#[test]
fn a_branch_interrupted_after_every_step_is_the_same_to_the_last_bit() {
    let cusp: Equation = |y, l| [l + y - y * y * y, 1.0 - 3.0 * y * y, 1.0];
    let circle: Equation = |y, l| [y * y + l * l - 1.0, 2.0 * y, 2.0 * l];
    let cases =
        [(cusp, 0.0, 0.0, [-1.0, 1.5], End::Bound), (circle, 0.8, 0.6, [-2.0, 2.0], End::Closed)];
    // Scales that make scaled and plain unknowns differ by more than a power of two.
    let scales = Scales { unknowns: vec![0.7], parameter: 1.3 };
    for (equation, y, lambda, bounds, end) in cases {
        let options = ContinuationOptions::within(bounds);
        let mut family = Counted { equation, evaluations: 0 };
        let whole =
            trace_both(&mut family, (&[y], lambda), &scales, &options, &mut Unkept).unwrap();
        assert_eq!(whole.ends, [end.clone(), end]);
        assert_eq!(whole.folds().count(), 2);
        let (found, interruptions, [_, evaluations]) = interrupted(equation, |family, steps| {
            trace_both(family, (&[y], lambda), &scales, &options, steps)
        });
        println!("{interruptions} interruptions of {} points", whole.points.len());
        assert_eq!(found, whole);
        assert!(interruptions > 20);
        assert_eq!(evaluations, 0);
    }
}

/// The branch off a pitchfork, interrupted likewise; one that ends for a reason finds the same reason again.
#[test]
fn a_branch_off_another_one_is_gone_on_with() {
    let fork: Equation = |y, l| [y * (l - y * y), l - 3.0 * y * y, y];
    let scales = Scales { unknowns: vec![0.7], parameter: 1.3 };
    let most_points = 12;
    for options in [
        ContinuationOptions::within([-1.0, 1.0]),
        ContinuationOptions { most_points, ..ContinuationOptions::within([-1.0, 1.0]) },
    ] {
        let mut family = Counted { equation: fork, evaluations: 0 };
        let trunk = trace_both(
            &mut family,
            (&[0.0], -0.5),
            &scales,
            &ContinuationOptions::within([-1.0, 1.0]),
            &mut Unkept,
        )
        .unwrap();
        let from = trunk.bifurcations().next().unwrap();
        let whole =
            branch_off(&mut family, (from, &[1.0]), &scales, &options, &mut Unkept).unwrap();
        let (found, interruptions, _) = interrupted(fork, |family, steps| {
            branch_off(family, (from, &[1.0]), &scales, &options, steps)
        });
        println!("{interruptions} interruptions of {} points", whole.points.len());
        assert_eq!(found, whole);
        assert!(interruptions + 1 >= whole.points.len() / 2);
    }
}
