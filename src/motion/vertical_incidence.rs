//! Vertically incident S and P waves.

use super::{FreeField, Record};

/// Vertically incident S and P waves: the surface moves by the records, the same at all points.
///
/// The records are the motion of the free *surface* (twice the incident wave), S giving the
/// horizontal and P the vertical component. A plain [`Record`] is a horizontal free field too.
///
/// ```
/// use basemat::motion::{FreeField, Record, VerticalIncidence};
/// let shake = Record::new(0.5, vec![1.0, 1.0, 1.0])?;
/// let field = VerticalIncidence::new(shake.clone()).with_vertical(shake.scaled(0.5)?);
/// assert_eq!(field.displacement(7.0, 1.0), [0.5, 0.25]);
/// assert_eq!(field.velocity(-7.0, 1.0), [1.0, 0.5]);
/// # Ok::<(), basemat::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct VerticalIncidence {
    horizontal: Option<Record>,
    vertical: Option<Record>,
}

impl VerticalIncidence {
    /// S wave: the surface moves horizontally by `record`, positive to the right.
    pub fn new(record: Record) -> Self {
        Self { horizontal: Some(record), vertical: None }
    }

    /// P wave: the surface moves vertically by `record`, positive up.
    pub fn vertical(record: Record) -> Self {
        Self { horizontal: None, vertical: Some(record) }
    }

    /// Adds (or replaces) the vertical component, positive up; its time step may differ.
    #[must_use]
    pub fn with_vertical(self, record: Record) -> Self {
        Self { vertical: Some(record), ..self }
    }
}

impl From<Record> for VerticalIncidence {
    fn from(record: Record) -> Self {
        Self::new(record)
    }
}

impl FreeField for VerticalIncidence {
    fn displacement(&self, _x: f64, time: f64) -> [f64; 2] {
        let at = |record: &Option<Record>| record.as_ref().map_or(0.0, |r| r.displacement_at(time));
        [at(&self.horizontal), at(&self.vertical)]
    }

    fn velocity(&self, _x: f64, time: f64) -> [f64; 2] {
        let at = |record: &Option<Record>| record.as_ref().map_or(0.0, |r| r.velocity_at(time));
        [at(&self.horizontal), at(&self.vertical)]
    }
}

impl FreeField for Record {
    fn displacement(&self, _x: f64, time: f64) -> [f64; 2] {
        [self.displacement_at(time), 0.0]
    }

    fn velocity(&self, _x: f64, time: f64) -> [f64; 2] {
        [self.velocity_at(time), 0.0]
    }
}
