//! Similarity of mode shapes.

use faer::{Mat, c64};

/// A shape is linearly dependent if its component normal to the others is below this share of the largest
/// norm.
const DEPENDENT: f64 = 1e-8;

/// Squared cosine of the angle between a shape and the span of others, all over the same outputs:
/// the modal assurance criterion |φ̄·ψ|² / (|φ|²|ψ|²) generalised to repeated poles, which have a space of shapes.
/// NaN for a shape of zeros.
pub fn share_in_span(shape: &[c64], span: &[&[c64]]) -> f64 {
    let at = |j: usize, i: usize| span[j].get(i).copied().unwrap_or(c64::new(0.0, 0.0));
    let qr = Mat::from_fn(shape.len(), span.len(), |i, j| at(j, i)).col_piv_qr();
    let (q, r) = (qr.compute_thin_Q(), qr.thin_R());
    let total: f64 = shape.iter().map(|x| x.norm_sqr()).sum();
    let along = |j: usize| -> f64 {
        let product: c64 = shape.iter().enumerate().map(|(i, x)| q[(i, j)].conj() * x).sum();
        product.norm_sqr()
    };
    let independent = |j: &usize| r[(*j, *j)].norm() > DEPENDENT * r[(0, 0)].norm();
    (0..q.ncols()).filter(independent).map(along).sum::<f64>() / total
}

#[cfg(test)]
mod tests {
    use super::*;

    fn real(values: [f64; 3]) -> Vec<c64> {
        values.iter().map(|x| c64::new(*x, 0.0)).collect()
    }

    #[test]
    fn scale_and_phase_do_not_count() {
        let mac = |a: &[c64], b: &[c64]| share_in_span(a, &[b]);
        let a = real([1.0, 2.0, -1.0]);
        let b: Vec<c64> = a.iter().map(|x| x * c64::new(-0.3, 0.4)).collect();
        assert!((mac(&a, &b) - 1.0).abs() < 1e-14);
        assert!(mac(&a, &real([1.0, 0.0, 1.0])) < 1e-30);
        // cos² of the angle between (1, 0, 0) and (1, 1, 0).
        assert!((mac(&real([1.0, 0.0, 0.0]), &real([1.0, 1.0, 0.0])) - 0.5).abs() < 1e-14);
    }

    #[test]
    fn a_span_holds_its_mixtures_and_dependent_shapes_add_nothing() {
        let (a, b) = (real([1.0, 0.0, 0.0]), real([1.0, 1.0, 0.0]));
        let mixed = real([3.0, -2.0, 0.0]);
        assert!((share_in_span(&mixed, &[&a, &b]) - 1.0).abs() < 1e-14);
        assert!(share_in_span(&real([0.0, 0.0, 1.0]), &[&a, &b]) < 1e-30);
        let along = share_in_span(&real([0.0, 1.0, 1.0]), &[&a, &a, &a]);
        assert!(along < 1e-14, "{along}");
    }
}
