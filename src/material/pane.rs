//! A clear pane as one surface, from its normal transmittance or from a measured table. A newcomer's mistake: the
//! tabled transmittance of a pane includes both Fresnel surfaces and what is absorbed between them.

/// Most angles of a measured table: every 10°, as glazing is tabled.
pub const MOST_ANGLES: usize = 10;

/// A pane that passes light straight on and mirrors some, the same from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "a scene has few materials, and they are read by reference")]
pub enum Pane {
    /// A plane-parallel plate of one glass, by Fresnel's formulas and Bouguer's law.
    Plate {
        /// Refractive index.
        index: f64,
        /// Internal transmittance at normal incidence, surfaces excluded.
        internal: f64,
    },
    /// As measured: coated, laminated, several panes taken as one.
    Measured(Table),
}

/// Transmittance and reflectance by angle of incidence, linear in the angle between those that are given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// Angle of incidence in degrees, transmittance, reflectance; the last one is repeated to the end.
    rows: [[f64; 3]; MOST_ANGLES],
}

/// Refractive index of soda-lime glass.
const SODA_LIME: f64 = 1.52;

impl Table {
    /// A table from rows of {angle of incidence in degrees, transmittance, reflectance}.
    ///
    /// # Errors
    /// What is wrong with it: it must lead from 0° to 90° in rising angles, with shares from 0 that together make no
    /// more than 1.
    pub fn new(rows: &[[f64; 3]]) -> Result<Self, String> {
        if !(2..=MOST_ANGLES).contains(&rows.len()) {
            return Err(format!("a table has 2 to {MOST_ANGLES} angles, found {}", rows.len()));
        }
        for &[angle_deg, passed, reflected] in rows {
            let are_shares = (0.0..=1.0).contains(&passed) && (0.0..=1.0).contains(&reflected);
            if !(are_shares && passed + reflected <= 1.0 + 1e-9) {
                return Err(format!(
                    "transmittance and reflectance at {angle_deg}° must be shares that make no more than 1, found {passed} and {reflected}"
                ));
            }
        }
        if let Some(pair) = rows.windows(2).find(|pair| !(pair[1][0] > pair[0][0])) {
            return Err(format!("angles must rise, found {}° after {}°", pair[1][0], pair[0][0]));
        }
        let (first, last) = (rows[0], rows[rows.len() - 1]);
        if [first[0], last[0]].map(f64::to_bits) != [0.0f64, 90.0].map(f64::to_bits) {
            return Err(format!("angles must lead from 0 to 90°, found {} to {}°", first[0], last[0]));
        }
        Ok(Self { rows: std::array::from_fn(|row| *rows.get(row).unwrap_or(&last)) })
    }

    /// Transmittance and reflectance at |cos| of incidence.
    fn at(&self, cos: f64) -> (f64, f64) {
        let angle_deg = cos.clamp(0.0, 1.0).acos().to_degrees();
        let next = self.rows.iter().position(|row| row[0] >= angle_deg).unwrap_or(MOST_ANGLES - 1).max(1);
        let ([low, t0, r0], [high, t1, r1]) = (self.rows[next - 1], self.rows[next]);
        let part = ((angle_deg - low) / (high - low)).min(1.0);
        (t0 + part * (t1 - t0), r0 + part * (r1 - r0))
    }
}

impl Pane {
    /// A pane of soda-lime glass without absorption (normal transmittance 0.9176).
    #[cfg(test)]
    pub(super) const CLEAR: Self = Self::Plate { index: SODA_LIME, internal: 1.0 };

    /// The pane with transmittance `normal_transmittance` (0 … 1) at normal incidence.
    ///
    /// With the Fresnel reflectance r of one surface and internal transmittance τ:
    /// T = (1−r)² τ / (1 − r² τ²), solved for τ at n = 1.52. A pane that passes more than soda-lime
    /// glass can (0.918) is taken as free of absorption with the index that gives T = (1−r)/(1+r).
    pub fn new(normal_transmittance: f64) -> Self {
        let t = normal_transmittance;
        let r = fresnel(1.0, SODA_LIME)[0];
        let clearest = (1.0 - r) / (1.0 + r);
        if t > clearest {
            let root = ((1.0 - t) / (1.0 + t)).sqrt();
            return Self::Plate { index: (1.0 + root) / (1.0 - root), internal: 1.0 };
        }
        let q = (1.0 - r) * (1.0 - r);
        let internal = if t > 0.0 { 2.0 * t / (q + (q * q + 4.0 * t * t * r * r).sqrt()) } else { 0.0 };
        Self::Plate { index: SODA_LIME, internal }
    }

    /// Transmittance at |cos| of incidence, mean of both polarisations.
    pub fn transmittance(&self, cos: f64) -> f64 {
        self.at(cos).0
    }

    /// Reflectance at |cos| of incidence, mean of both polarisations.
    pub fn reflectance(&self, cos: f64) -> f64 {
        self.at(cos).1
    }

    /// Whether any light is absorbed inside.
    pub fn absorbs(&self) -> bool {
        match self {
            Self::Plate { internal, .. } => *internal < 1.0,
            Self::Measured(table) => table.rows.iter().any(|[_, passed, reflected]| passed + reflected < 1.0),
        }
    }

    fn at(&self, cos: f64) -> (f64, f64) {
        match self {
            Self::Plate { index, internal } => plate(*index, *internal, cos),
            Self::Measured(table) => table.at(cos),
        }
    }
}

/// Transmittance and reflectance of a plate with all reflections between its surfaces, mean of both polarisations.
fn plate(index: f64, internal: f64, cos: f64) -> (f64, f64) {
    let sin_inside_squared = (1.0 - cos * cos) / (index * index);
    let path = 1.0 / (1.0 - sin_inside_squared).sqrt();
    let tau = internal.powf(path);
    let (mut passed, mut reflected) = (0.0, 0.0);
    for r in fresnel(cos, index) {
        let t = (1.0 - r) * (1.0 - r) * tau / (1.0 - r * r * tau * tau).max(f64::MIN_POSITIVE);
        passed += 0.5 * t;
        reflected += 0.5 * (r + r * tau * t);
    }
    (passed, reflected)
}

/// Fresnel reflectance of one surface for s and p polarisation at |cos| of incidence in air.
fn fresnel(cos: f64, index: f64) -> [f64; 2] {
    let cos_inside = (1.0 - (1.0 - cos * cos) / (index * index)).sqrt();
    let s = (cos - index * cos_inside) / (cos + index * cos_inside);
    let p = (index * cos - cos_inside) / (index * cos + cos_inside);
    [s * s, p * p]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_transmittance_is_given_back() {
        for t in [0.0, 0.1, 0.5, 0.88, 0.9, 0.917, 0.95, 1.0] {
            assert!((Pane::new(t).transmittance(1.0) - t).abs() < 1e-12, "{t}");
        }
    }

    #[test]
    fn a_clear_pane_loses_nothing_and_blocks_at_grazing() {
        for cos in [1e-6, 0.1, 0.5, 1.0] {
            let pane = Pane::CLEAR;
            assert!((pane.transmittance(cos) + pane.reflectance(cos) - 1.0).abs() < 1e-12);
        }
        assert!(Pane::CLEAR.transmittance(1e-6) < 1e-4);
        // n = 1.52 at 60°: r_s = 0.18255, r_p = 0.00181 → T = ½ Σ (1−r)/(1+r) = 0.8438.
        assert!((Pane::CLEAR.transmittance(0.5) - 0.8438).abs() < 1e-3, "{}", Pane::CLEAR.transmittance(0.5));
    }

    /// Catches: a table read by the cosine, by the wrong neighbours, or past its ends.
    #[test]
    fn a_measured_pane_gives_its_table_back_and_is_linear_in_the_angle_between() {
        let rows = [[0.0, 0.8, 0.1], [30.0, 0.7, 0.12], [60.0, 0.5, 0.2], [90.0, 0.0, 1.0]];
        let pane = Pane::Measured(Table::new(&rows).expect("a good table"));
        for (angle_deg, passed, reflected) in
            [(0.0, 0.8, 0.1), (15.0, 0.75, 0.11), (60.0, 0.5, 0.2), (75.0, 0.25, 0.6), (90.0, 0.0, 1.0)]
        {
            let cos = f64::to_radians(angle_deg).cos();
            let (t, r) = (pane.transmittance(cos), pane.reflectance(cos));
            assert!((t - passed).abs() < 1e-12 && (r - reflected).abs() < 1e-12, "{angle_deg}°: {t}, {r}");
        }
        assert!(pane.absorbs());
        // A plate sampled every 10° misses half of the bend in the middle of a step, as lines do.
        let plate = Pane::new(0.88);
        let cosine = |angle_deg: f64| angle_deg.to_radians().cos().max(1e-9);
        let passed = |angle_deg: f64| plate.transmittance(cosine(angle_deg));
        let row = |k: u32| {
            let angle_deg = 10.0 * f64::from(k);
            [angle_deg, passed(angle_deg), plate.reflectance(cosine(angle_deg))]
        };
        let table = Table::new(&(0..=9).map(row).collect::<Vec<_>>()).expect("a good table");
        let table = Pane::Measured(table);
        for middle_deg in [5.0, 25.0, 45.0, 65.0] {
            let missed = passed(middle_deg) - table.transmittance(cosine(middle_deg));
            let bend = 2.0 * passed(middle_deg) - passed(middle_deg - 5.0) - passed(middle_deg + 5.0);
            assert!((missed - 0.5 * bend).abs() < 1e-9, "{middle_deg}°: {missed}, {bend}");
        }
    }

    #[test]
    fn a_wrong_table_says_what_is_wrong() {
        let end = [90.0, 0.0, 1.0];
        for (rows, what) in [
            (vec![end], "2 to 10 angles"),
            (vec![[0.0, 0.8, 0.3], end], "no more than 1, found 0.8 and 0.3"),
            (vec![[0.0, f64::NAN, 0.3], end], "must be shares"),
            (vec![[10.0, 0.8, 0.1], end], "from 0 to 90°, found 10 to 90°"),
            (vec![[0.0, 0.8, 0.1], [60.0, 0.8, 0.1], [60.0, 0.8, 0.1], end], "found 60° after 60°"),
            (vec![[0.0, 0.8, 0.1], [f64::NAN, 0.8, 0.1], end], "must rise"),
        ] {
            let error = Table::new(&rows).expect_err("refused");
            assert!(error.contains(what), "{error}");
        }
    }
}
