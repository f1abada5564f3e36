//! Rows of inputs and outputs, whose places may be used again.

/// Numbers of a cache line.
const LINE: usize = 8;

/// A row for each normal component, then one for each tangential one: inputs before the present step,
/// outputs as far as known from there on.
///
/// By itself, a step is an array of the same numbers: of each of the two kinds of components all real parts
/// before all imaginary ones, if they have any.
pub(super) struct Rows {
    pub(super) values: Vec<f64>,
    /// Length of a row.
    pub(super) stride: usize,
    /// Numbers of a step.
    width: usize,
    /// Numbers of a component: one, or a real and an imaginary part.
    parts: usize,
    /// Steps after which places are used again.
    period: usize,
}

impl Rows {
    /// For steps of `width` numbers, without room; places are used again after `period` steps.
    pub(super) fn new([width, parts]: [usize; 2], period: usize) -> Self {
        Self { values: Vec::new(), stride: 0, width, parts, period }
    }

    /// Makes room for at least `steps` steps.
    pub(super) fn lengthen(&mut self, steps: usize) {
        // An odd number of lines: else equal places of all rows fall into few sets of the cache.
        let stride = (steps * self.parts).next_multiple_of(2 * LINE) + LINE;
        let mut values = vec![0.0; self.width / self.parts * stride];
        let old = self.values.chunks_exact(self.stride.max(1));
        for (new, old) in values.chunks_exact_mut(stride).zip(old) {
            new[..self.stride].copy_from_slice(old);
        }
        (self.values, self.stride) = (values, stride);
    }

    /// Where in its row a step is.
    pub(super) fn place(&self, step: usize) -> usize {
        self.parts * if step < self.period { step } else { step % self.period }
    }

    /// Where the numbers of a step are, in the order of the step.
    fn places(&self, step: usize) -> impl Iterator<Item = usize> + use<> {
        let (begin, parts, stride) = (self.place(step), self.parts, self.stride);
        let count = self.width / (2 * parts);
        (0..2 * parts).flat_map(move |part| {
            let begin = part / parts * count * stride + begin + part % parts;
            (0..count).map(move |row| begin + row * stride)
        })
    }

    /// Numbers of `step`.
    pub(super) fn step(&self, step: usize) -> impl Iterator<Item = f64> {
        self.places(step).map(|place| self.values[place])
    }

    /// Overwrites what stands from step `begin` on, the multiple of a leaf, by the `steps` of one.
    pub(super) fn write(&mut self, begin: usize, steps: &[f64]) {
        for (number, place) in self.places(begin).enumerate() {
            let row = self.values[place..].iter_mut().step_by(self.parts);
            row.zip(steps.chunks_exact(self.width)).for_each(|(own, step)| *own = step[number]);
        }
    }

    /// Overwrites the `steps` of a leaf by what stands from step `begin` on.
    pub(super) fn read(&self, begin: usize, steps: &mut [f64]) {
        for (number, place) in self.places(begin).enumerate() {
            let row = self.values[place..].iter().step_by(self.parts);
            row.zip(steps.chunks_exact_mut(self.width)).for_each(|(own, step)| step[number] = *own);
        }
    }

    /// The `size` inputs before `now`, a block of their size.
    pub(super) fn inputs(&self, row: usize, now: usize, size: usize) -> &[f64] {
        &self.values[row * self.stride + self.place(now - size)..][..size * self.parts]
    }

    /// The `size` outputs from `now` on, or as many as there are.
    pub(super) fn outputs(&mut self, row: usize, now: usize, size: usize) -> &mut [f64] {
        let begin = self.place(now);
        let end = self.stride.min(begin + size * self.parts);
        &mut self.values[row * self.stride..][begin..end]
    }

    /// Clears the places of old inputs that outputs from `now` on take.
    pub(super) fn renew(&mut self, now: usize) {
        let half = self.period / 2;
        if now.is_multiple_of(half) {
            for row in 0..self.width / self.parts {
                self.outputs(row, now, half).fill(0.0);
            }
        }
    }
}
