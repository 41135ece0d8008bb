//! Studies of functions whose answers are known: integrals by rules of known order and cost.

use std::f64::consts::E;

use dynamics::extrapolate;

use super::cost::{interleaved, quartiles};
use super::efficiency::{Candidate, Doubt, Judged, judge};
use super::result::RouteResult;
use super::truth::truth;

/// ∫₀¹ eˣ dx = e − 1, and the number of evaluations it took.
type Rule = fn(u32) -> (f64, u32);

fn at(n: u32, i: f64) -> f64 {
    (i / f64::from(n)).exp()
}

/// Order 2, error +h² (e − 1)/12 to first order; n + 1 evaluations.
fn trapezoidal(n: u32) -> (f64, u32) {
    let inner: f64 = (1..n).map(|i| at(n, f64::from(i))).sum();
    ((0.5 * (1.0 + E) + inner) / f64::from(n), n + 1)
}

/// Order 2, error −h² (e − 1)/24 to first order; n evaluations.
fn midpoint(n: u32) -> (f64, u32) {
    ((0..n).map(|i| at(n, f64::from(i) + 0.5)).sum::<f64>() / f64::from(n), n)
}

/// Order 4; 2n + 1 evaluations.
fn simpson(n: u32) -> (f64, u32) {
    ((trapezoidal(n).0 + 2.0 * midpoint(n).0) / 3.0, 2 * n + 1)
}

const REFINED: [u32; 3] = [4, 8, 16];

fn route(rule: Rule, refined: &[u32], order: Option<f64>) -> RouteResult {
    let values: Vec<f64> = refined.iter().map(|n| rule(*n).0).collect();
    let n: Vec<f64> = refined.iter().map(|n| f64::from(*n)).collect();
    let own = extrapolate(&values, &n, order);
    RouteResult {
        name: String::new(),
        value: own.value,
        uncertainty: own.uncertainty,
        order: own.order,
        values,
    }
}

/// Timed on a clock that counts evaluations, in units of a yardstick of ten.
fn study(rules: &[(Rule, [u32; 3])], truth_value: f64, uncertainty: f64) -> Vec<Judged> {
    let list: Vec<(usize, usize, (f64, u32))> = rules
        .iter()
        .enumerate()
        .flat_map(|(k, (rule, n))| n.iter().enumerate().map(move |(i, n)| (k, i, rule(*n))))
        .collect();
    let timed = |_: usize, i: usize| Ok::<_, ()>(vec![f64::from(list[i].2.1)]);
    let timings = interleaved(3, list.len(), || Ok(10.0), timed).unwrap();
    let candidates: Vec<Candidate> = list
        .iter()
        .zip(&timings.ratios)
        .map(|((series, place, (value, evaluations)), ratios)| {
            let cost = quartiles(&ratios[0]).median;
            assert!((cost - 0.1 * f64::from(*evaluations)).abs() < 1e-12);
            Candidate { value: *value, cost, place: Some((*series, *place)) }
        })
        .collect();
    judge(truth_value, uncertainty, &candidates)
}

#[test]
fn the_known_truth_lies_within_a_known_uncertainty() {
    for (rule, order) in [(trapezoidal as Rule, 2.0), (midpoint, 2.0), (simpson, 4.0)] {
        let own = route(rule, &[16, 32, 64], Some(order));
        assert!((own.order.unwrap() - order).abs() < 0.01, "{own:?}");
        let off = (own.value - (E - 1.0)).abs();
        assert!(off <= own.uncertainty, "{off:e} {own:?}");
        // U = 1.25 of the finest error: that is known in closed form to first order.
        let finest = (rule(64).0 - (E - 1.0)).abs();
        assert!((own.uncertainty / finest - 1.25).abs() < 0.01, "{own:?}");
    }
}

/// Evaluations and leading errors over (e − 1): midpoint n, 1/(24 n²); trapezoidal n + 1, 1/(12 n²); Simpson 2n + 1,
/// 1/(2880 n⁴). By hand: midpoint at 4 (cost 4, 2.6e-3) is the cheapest; at 8 (8, 6.5e-4) it is beaten by nothing
/// cheaper, Simpson at 4 costs 9 and has 1.4e-6; from there on only Simpson at 8 (17) and 16 (33) are better.
/// Trapezoidal at 4 (5, 5.2e-3), 8 (9) and 16 (17), midpoint at 16 (16) are beaten.
#[test]
fn the_known_front_is_found() {
    let routes = vec![
        route(simpson, &[16, 32, 64], Some(4.0)),
        route(trapezoidal, &[256, 512, 1024], Some(2.0)),
    ];
    let found = truth(routes).unwrap();
    let rules = [(midpoint as Rule, REFINED), (trapezoidal, REFINED), (simpson, REFINED)];
    let judged = study(&rules, found.value, found.uncertainty);
    let front: Vec<bool> = judged.iter().map(|j| j.is_efficient).collect();
    assert_eq!(front, [true, true, false, false, false, false, true, true, true]);
    assert!(judged.iter().all(|j| j.doubt.is_none()));
    // Errors of either sign, in percent.
    assert!((judged[0].error_percent + 100.0 / (24.0 * 16.0)).abs() < 0.01, "{:?}", judged[0]);
    assert!((judged[3].error_percent - 100.0 / (12.0 * 16.0)).abs() < 0.01, "{:?}", judged[3]);
}

/// A first-order error −8/n² + 1/n crosses zero at n = 8: at n = 7 it is smaller than at 16 and 32.
#[test]
fn a_rule_whose_error_crosses_zero_is_not_taken_for_accurate() {
    let crossing: Rule = |n| {
        let n = f64::from(n);
        (E - 1.0 + 1.0 / n - 8.0 / (n * n), n as u32)
    };
    let rules = [(crossing, [7, 16, 32]), (midpoint as Rule, REFINED)];
    let judged = study(&rules, E - 1.0, 1e-6);
    assert_eq!(judged[0].doubt, Some(Doubt::Crossing));
    assert!(judged[0].guarded_percent > 1.5 * judged[0].error_percent.abs());
    assert!(judged[1..].iter().all(|j| j.doubt.is_none()), "{judged:?}");
}

/// A truth moved by more than U by its second route opens ranks that the first alone gives as certain.
#[test]
fn a_second_route_farther_off_than_u_opens_ranks() {
    let rules = [(midpoint as Rule, REFINED), (trapezoidal, REFINED)];
    let first = route(simpson, &[16, 32, 64], Some(4.0));
    let alone = truth(vec![first.clone()]).unwrap();
    let sure = study(&rules, alone.value, alone.uncertainty);
    assert!(sure.iter().all(|j| !j.is_rank_uncertain()), "{sure:?}");
    // Off by as much as midpoint at 16, 1.6e-4: its rank and those of its neighbours hang on it.
    let other = RouteResult { value: midpoint(16).0, uncertainty: 0.0, ..first.clone() };
    let both = truth(vec![first, other]).unwrap();
    let open = study(&rules, both.value, both.uncertainty);
    assert!(open[2].is_rank_uncertain() && open[5].is_rank_uncertain(), "{open:?}");
    assert!(open[2].is_within_uncertainty && !open[0].is_within_uncertainty);
}
