//! Value references to slots, by the span: hosts ask for dozens of variables a step, and mostly for neighbours.

use std::ops::Range;

/// Variables whose value references follow each other, and their slots too.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    /// Value reference of the first one.
    first: u32,
    slot: usize,
    len: usize,
}

/// All variables of one base type in spans, as long as can be, of those that have the same `T`.
#[derive(Debug, Clone)]
pub struct Spans<T> {
    spans: Vec<(Span, T)>,
    /// By value reference, the index among `spans`, beyond them where there is no variable: references are small numbers.
    span_of: Vec<u16>,
}

impl<T: PartialEq> Spans<T> {
    /// Of variables by slot, each with its value reference.
    pub fn new(variables: impl Iterator<Item = (u32, T)>) -> Self {
        let mut spans: Vec<(Span, T)> = Vec::new();
        for (slot, (reference, what)) in variables.enumerate() {
            match spans.last_mut() {
                Some((span, same)) if span.place(reference) == span.len && *same == what => span.len += 1,
                _ => spans.push((Span { first: reference, slot, len: 1 }, what)),
            }
        }
        let mut span_of = Vec::new();
        for (index, (span, _)) in (0..).zip(&spans) {
            let references = span.first as usize..span.first as usize + span.len;
            span_of.resize(span_of.len().max(references.end), u16::MAX);
            span_of[references].fill(index);
        }
        Self { spans, span_of }
    }

    /// The span that a value reference belongs to.
    #[inline]
    pub fn of(&self, reference: u32) -> Option<&(Span, T)> {
        self.spans.get(*self.span_of.get(reference as usize)? as usize)
    }
}

impl Span {
    /// Where its variables are among the `values` by slot.
    #[inline]
    pub fn slots(&self) -> Range<usize> {
        self.slot..self.slot + self.len
    }

    /// The place of a variable in the span, beyond its end if it belongs to another.
    #[inline]
    pub fn place(&self, reference: u32) -> usize {
        reference.wrapping_sub(self.first) as usize
    }

    /// The slots behind `references` if these follow each other within the span, as those of most requests do.
    #[inline]
    pub fn run(&self, references: &[u32]) -> Option<Range<usize>> {
        let (first, last) = (*references.first()?, self.place(*references.last()?));
        let place = self.place(first);
        // without an early end, so that several are compared at once
        let follow = |differences, (reference, expected)| differences | (reference ^ expected);
        let run = last < self.len
            && last.wrapping_sub(place) == references.len() - 1
            && references.iter().zip(first..).fold(0, follow) == 0;
        run.then(|| self.slot + place..self.slot + place + references.len())
    }

    /// Copies from the span's `values` those behind the first of `references`, as long as these are within it; how many.
    #[inline]
    pub fn gather(&self, values: &[f64], references: &[u32], out: &mut [f64]) -> usize {
        let value = |reference: u32| values.get(self.place(reference));
        let mut done = 0;
        // four at a time, for a loop costs as much as what is in it
        for (references, out) in references.as_chunks().0.iter().zip(out.as_chunks_mut().0) {
            let [Some(a), Some(b), Some(c), Some(d)] = references.map(value) else { break };
            *out = [*a, *b, *c, *d];
            done += out.len();
        }
        for (&reference, out) in references[done..].iter().zip(&mut out[done..]) {
            let Some(&value) = value(reference) else { break };
            *out = value;
            done += 1;
        }
        done
    }

    /// Whether all `references` are within the span.
    #[inline]
    pub fn contains(&self, references: &[u32]) -> bool {
        references.iter().fold(true, |all, &reference| all & (self.place(reference) < self.len))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_goes_on_as_long_as_references_and_kind_do() {
        let spans = Spans::new([(7, 'a'), (8, 'a'), (9, 'b'), (3, 'b'), (4, 'b')].into_iter());
        let slots = |reference| spans.of(reference).map(|(span, what)| (span.slots(), *what));
        assert_eq!(slots(7), Some((0..2, 'a')));
        assert_eq!(slots(8), Some((0..2, 'a')));
        assert_eq!(slots(9), Some((2..3, 'b')));
        assert_eq!(slots(4), Some((3..5, 'b')));
        for reference in [0, 2, 5, 6, 10, u32::MAX] {
            assert_eq!(slots(reference), None);
        }
    }

    #[test]
    fn a_run_is_in_order_and_within_the_span() {
        let spans = Spans::new([0, 10, 11, 12, 13].map(|reference| (reference, ())).into_iter());
        let (span, ()) = spans.of(12).unwrap();
        assert_eq!(span.run(&[11, 12, 13]), Some(2..5));
        for references in [&[12, 11][..], &[11, 13], &[12, 13, 14], &[9, 10], &[11, 11], &[10, 12, 11, 13], &[]] {
            assert_eq!(span.run(references), None);
        }
        assert!(span.contains(&[13, 10, 10]));
        assert!(!span.contains(&[13, 14]) && !span.contains(&[9]));
    }
}
