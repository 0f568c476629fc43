//! Spindle, beam and pen: how the tool is made to work, changed and put to rest.

use super::{Decimal, WriteError, Writer, rate};
use crate::cam::Settings;
use crate::gcode::MachineKind;

impl Writer<'_> {
    /// The S of a spindle speed or of a power.
    fn speed_word(&self, speed: f64) -> Result<String, WriteError> {
        let Some(full) = self.dialect.spindle_full else { return rate("spindle speed", speed) };
        if speed > full.rpm {
            return Err(WriteError::Speed { dialect: self.dialect.name.clone(), speed, most: full.rpm });
        }
        rate("spindle speed", speed / full.rpm * full.word)
    }

    /// Starts a spindle and waits for it, unless it runs so already; keeps the power of a beam for later.
    pub(super) fn start_spindle(&mut self, settings: &Settings) -> Result<(), WriteError> {
        let speed = self.speed_word(settings.spindle_speed)?;
        let is_new = self.speed != speed;
        if self.dialect.machine == MachineKind::Router {
            if is_new {
                self.line(&self.dialect.spindle_on.replace("{speed}", &speed));
                self.speed = speed;
                self.wait(settings.dwell)?;
            }
        } else if is_new {
            // A beam that is on gets its new power with the next cut.
            self.engage(false)?;
            self.speed = speed;
        }
        Ok(())
    }

    fn wait(&mut self, seconds: f64) -> Result<(), WriteError> {
        let dialect = self.dialect;
        // A dialect whose letter has no unit is refused when it is read.
        let unit = dialect.dwell_units.get(&dialect.dwell_word);
        if let Some(unit) = unit.filter(|_| dialect.spindle_dwell) {
            let time = seconds * unit.per_second();
            let time = if dialect.dwell_decimals == 0 { time.ceil() } else { time };
            self.line(&format!("G4 {}{}", dialect.dwell_word, rate("dwell", time)?));
        }
        Ok(())
    }

    /// Stops the spindle, or makes sure that the beam is off and the pen up.
    pub(super) fn stop_spindle(&mut self) -> Result<(), WriteError> {
        if self.dialect.machine == MachineKind::Router {
            self.line(&self.dialect.spindle_off);
        } else {
            self.engage(false)?;
        }
        self.speed.clear();
        Ok(())
    }

    /// Makes the beam or the pen do its work, or rest; nothing where it does so already, and nothing for a spindle.
    pub(super) fn engage(&mut self, on: bool) -> Result<(), WriteError> {
        if self.dialect.machine == MachineKind::Router || self.is_engaged == Some(on) {
            return Ok(());
        }
        self.is_engaged = Some(on);
        let dialect = self.dialect;
        match dialect.machine {
            MachineKind::Router => {}
            MachineKind::Laser if on => self.line(&dialect.spindle_on.replace("{speed}", &self.speed)),
            MachineKind::Laser => self.line(&dialect.spindle_off),
            MachineKind::Pen => match (dialect.pen_up_z, dialect.pen_down_z) {
                (Some(up), Some(down)) => self.move_pen(on, if on { down } else { up })?,
                _ => {
                    for line in if on { &dialect.pen_down } else { &dialect.pen_up } {
                        self.line(line);
                    }
                }
            },
        }
        Ok(())
    }

    fn move_pen(&mut self, down: bool, z: f64) -> Result<(), WriteError> {
        let place = self.grid.round(z).ok_or(WriteError::Rate { what: "height of the pen", value: z })?;
        let word = if down { "G1" } else { "G0" };
        let mut words = format!("{word} Z{}", self.grid.text(place));
        if down {
            self.add_feed(&mut words, self.plunge_feed)?;
        }
        self.line(&words);
        Ok(())
    }

    /// G64 P, where the dialect has a tolerance.
    pub(super) fn corner_tolerance(&mut self) -> Result<(), WriteError> {
        if let Some(tolerance) = self.dialect.corner_tolerance.filter(|t| *t > 0.0) {
            let decimals = self.dialect.decimals_inch.max(self.dialect.decimals_mm);
            let p = Decimal::of(tolerance / self.unit, decimals);
            let p = p.ok_or(WriteError::Rate { what: "corner tolerance", value: tolerance })?;
            self.line(&format!("G64 P{p}"));
        }
        Ok(())
    }
}
