//! Values that may be spelt in two ways, `maintenance = 0.8 | { llmf, lsf, lmf }`. Each has its own
//! visitor: `untagged` would answer every mistake with "data did not match any variant".

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, de};

/// A reflectance, or the name of a material.
#[derive(Clone, Debug, PartialEq)]
pub enum Surfacing {
    Reflectance(f64),
    Material(String),
}

/// A maintenance factor, or its components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Factor {
    Whole(f64),
    Parts { llmf: f64, lsf: f64, lmf: f64 },
}

/// The light of a luminaire in an emergency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EmergencyChoice {
    /// Share of the initial flux.
    Share(f64),
    /// lm.
    Flux(f64),
}

/// What a pane lets through.
#[derive(Clone, Debug, PartialEq)]
pub enum GlassChoice {
    /// Transmittance at normal incidence.
    Normal(f64),
    /// By angle of incidence, degrees.
    Measured { angle: Vec<f64>, transmittance: Vec<f64>, reflectance: Vec<f64> },
}

/// The light-emitting area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OpeningChoice {
    /// As the photometric file says.
    File,
    Rect([f64; 2]),
    Disc(f64),
}

/// How the points of an area are laid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AreaGrid {
    En,
    Step(f64),
    Count([usize; 2]),
}

/// `x` or `[x, y]`.
#[derive(Clone, Debug, PartialEq)]
pub struct OneOrTwo<T>(pub Vec<T>);

/// When to stop.
#[derive(Clone, Debug, PartialEq)]
pub enum GoalChoice {
    Verdict,
    Relative(f64),
    /// Seconds.
    Time(f64),
}

/// A text, or a TOML date taken as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextOrDate(pub String);

macro_rules! choice {
    ($type:ty, $expecting:literal, { $($method:item)* }) => {
        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Choice;
                impl<'de> Visitor<'de> for Choice {
                    type Value = $type;
                    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                        f.write_str($expecting)
                    }
                    $($method)*
                }
                deserializer.deserialize_any(Choice)
            }
        }
    };
}

choice!(Surfacing, "a reflectance or the name of a material", {
    fn visit_f64<E: Error>(self, value: f64) -> Result<Surfacing, E> {
        Ok(Surfacing::Reflectance(value))
    }
    fn visit_i64<E: Error>(self, value: i64) -> Result<Surfacing, E> {
        Ok(Surfacing::Reflectance(value as f64))
    }
    fn visit_str<E: Error>(self, value: &str) -> Result<Surfacing, E> {
        Ok(Surfacing::Material(value.to_owned()))
    }
});

choice!(Factor, "a factor or { llmf, lsf, lmf }", {
    fn visit_f64<E: Error>(self, value: f64) -> Result<Factor, E> {
        Ok(Factor::Whole(value))
    }
    fn visit_i64<E: Error>(self, value: i64) -> Result<Factor, E> {
        Ok(Factor::Whole(value as f64))
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Factor, A::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Parts {
            llmf: f64,
            lsf: f64,
            lmf: f64,
        }
        let Parts { llmf, lsf, lmf } = Parts::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Factor::Parts { llmf, lsf, lmf })
    }
});

choice!(
    GlassChoice,
    "a transmittance or { angle = [0, …, 90], transmittance = […], reflectance = […] }",
    {
        fn visit_f64<E: Error>(self, value: f64) -> Result<GlassChoice, E> {
            Ok(GlassChoice::Normal(value))
        }
        fn visit_i64<E: Error>(self, value: i64) -> Result<GlassChoice, E> {
            Ok(GlassChoice::Normal(value as f64))
        }
        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<GlassChoice, A::Error> {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Measured {
                angle: Vec<f64>,
                transmittance: Vec<f64>,
                reflectance: Vec<f64>,
            }
            let Measured { angle, transmittance, reflectance } =
                Measured::deserialize(MapAccessDeserializer::new(map))?;
            Ok(GlassChoice::Measured { angle, transmittance, reflectance })
        }
    }
);

choice!(EmergencyChoice, "a share of the flux or { flux = lumens }", {
    fn visit_f64<E: Error>(self, value: f64) -> Result<EmergencyChoice, E> {
        Ok(EmergencyChoice::Share(value))
    }
    fn visit_i64<E: Error>(self, value: i64) -> Result<EmergencyChoice, E> {
        Ok(EmergencyChoice::Share(value as f64))
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<EmergencyChoice, A::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Output {
            flux: f64,
        }
        Ok(EmergencyChoice::Flux(Output::deserialize(MapAccessDeserializer::new(map))?.flux))
    }
});

choice!(OpeningChoice, "\"file\", { rect = [length, width] } or { disc = diameter }", {
    fn visit_str<E: Error>(self, value: &str) -> Result<OpeningChoice, E> {
        match value {
            "file" => Ok(OpeningChoice::File),
            _ => Err(E::invalid_value(de::Unexpected::Str(value), &self)),
        }
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<OpeningChoice, A::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Shape {
            rect: Option<[f64; 2]>,
            disc: Option<f64>,
        }
        match Shape::deserialize(MapAccessDeserializer::new(map))? {
            Shape { rect: Some(rect), disc: None } => Ok(OpeningChoice::Rect(rect)),
            Shape { rect: None, disc: Some(disc) } => Ok(OpeningChoice::Disc(disc)),
            Shape { .. } => Err(A::Error::custom("give either `rect` or `disc`")),
        }
    }
});

choice!(AreaGrid, "\"en\", { step } or { count = [n, m] }", {
    fn visit_str<E: Error>(self, value: &str) -> Result<AreaGrid, E> {
        match value {
            "en" => Ok(AreaGrid::En),
            _ => Err(E::invalid_value(de::Unexpected::Str(value), &self)),
        }
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<AreaGrid, A::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Rule {
            step: Option<f64>,
            count: Option<[usize; 2]>,
        }
        match Rule::deserialize(MapAccessDeserializer::new(map))? {
            Rule { step: Some(step), count: None } => Ok(AreaGrid::Step(step)),
            Rule { step: None, count: Some(count) } => Ok(AreaGrid::Count(count)),
            Rule { .. } => Err(A::Error::custom("give either `step` or `count`")),
        }
    }
});

choice!(GoalChoice, "\"verdict\", { relative } or { time = \"2m\" }", {
    fn visit_str<E: Error>(self, value: &str) -> Result<GoalChoice, E> {
        match value {
            "verdict" => Ok(GoalChoice::Verdict),
            _ => Err(E::invalid_value(de::Unexpected::Str(value), &self)),
        }
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<GoalChoice, A::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Goal {
            relative: Option<f64>,
            time: Option<String>,
        }
        match Goal::deserialize(MapAccessDeserializer::new(map))? {
            Goal { relative: Some(relative), time: None } => Ok(GoalChoice::Relative(relative)),
            Goal { relative: None, time: Some(time) } => seconds(&time)
                .map(GoalChoice::Time)
                .ok_or_else(|| A::Error::custom("a time is written like \"30s\", \"2m\", \"1h\"")),
            Goal { .. } => Err(A::Error::custom("give either `relative` or `time`")),
        }
    }
});

choice!(TextOrDate, "a text or a date", {
    fn visit_str<E: Error>(self, value: &str) -> Result<TextOrDate, E> {
        Ok(TextOrDate(value.to_owned()))
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<TextOrDate, A::Error> {
        let date = toml::value::Datetime::deserialize(MapAccessDeserializer::new(map))?;
        Ok(TextOrDate(date.to_string()))
    }
});

impl<'de, T: Deserialize<'de> + Element> Deserialize<'de> for OneOrTwo<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Choice<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de> + Element> Visitor<'de> for Choice<T> {
            type Value = OneOrTwo<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}", T::EXPECTING)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<OneOrTwo<T>, E> {
                T::from_integer(value)
                    .map(|one| OneOrTwo(vec![one]))
                    .ok_or_else(|| E::invalid_value(de::Unexpected::Signed(value), &self))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<OneOrTwo<T>, A::Error> {
                let values = T::from_list(Vec::<Item>::deserialize(SeqAccessDeserializer::new(seq))?);
                values.map(OneOrTwo).ok_or_else(|| A::Error::custom(format!("expected {}", T::EXPECTING)))
            }
        }
        deserializer.deserialize_any(Choice(PhantomData))
    }
}

/// What [`OneOrTwo`] holds: counts or vectors.
pub trait Element: Sized {
    /// For the message.
    const EXPECTING: &'static str;
    /// From a lone integer.
    fn from_integer(value: i64) -> Option<Self>;
    /// From a list.
    fn from_list(items: Vec<Item>) -> Option<Vec<Self>>;
}

/// A number, or a list of three.
#[derive(Clone, Debug)]
pub enum Item {
    Number(f64),
    Vector([f64; 3]),
}

choice!(Item, "a number or [x, y, z]", {
    fn visit_f64<E: Error>(self, value: f64) -> Result<Item, E> {
        Ok(Item::Number(value))
    }
    fn visit_i64<E: Error>(self, value: i64) -> Result<Item, E> {
        Ok(Item::Number(value as f64))
    }
    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Item, A::Error> {
        <[f64; 3]>::deserialize(SeqAccessDeserializer::new(seq)).map(Item::Vector)
    }
});

impl Element for u32 {
    const EXPECTING: &'static str = "a count or two counts [n, m]";
    fn from_integer(value: i64) -> Option<Self> {
        Self::try_from(value).ok()
    }
    fn from_list(items: Vec<Item>) -> Option<Vec<Self>> {
        let counts: Option<Vec<Self>> = items
            .into_iter()
            .map(|item| match item {
                Item::Number(n) if n >= 0.0 && n <= f64::from(u32::MAX) && n.fract() == 0.0 => Some(n as u32),
                Item::Number(_) | Item::Vector(_) => None,
            })
            .collect();
        counts.filter(|counts| (1..=2).contains(&counts.len()))
    }
}

impl Element for [f64; 3] {
    const EXPECTING: &'static str = "a step [x, y, z] or two steps [[x, y, z], [x, y, z]]";
    fn from_integer(_: i64) -> Option<Self> {
        None
    }
    fn from_list(items: Vec<Item>) -> Option<Vec<Self>> {
        if let [Item::Number(x), Item::Number(y), Item::Number(z)] = items[..] {
            return Some(vec![[x, y, z]]);
        }
        let vectors: Option<Vec<Self>> = items
            .into_iter()
            .map(|item| match item {
                Item::Vector(vector) => Some(vector),
                Item::Number(_) => None,
            })
            .collect();
        vectors.filter(|vectors| (1..=2).contains(&vectors.len()))
    }
}

/// Reads `90s`, `2m`, `1.5h` or a plain number of seconds.
pub fn seconds(text: &str) -> Option<f64> {
    let text = text.trim();
    let (number, unit) = match text.char_indices().last()? {
        (at, 's') => (&text[..at], 1.0),
        (at, 'm') => (&text[..at], 60.0),
        (at, 'h') => (&text[..at], 3600.0),
        _ => (text, 1.0),
    };
    let seconds = number.trim().parse::<f64>().ok()? * unit;
    (seconds.is_finite() && seconds > 0.0).then_some(seconds)
}
