//! What may win: techniques over the grids of their parameters.

use gnomon_pipeline::technique::{Domain, ParamInfo, Technique, Value, Whole};

/// Keys and values.
pub(super) type Settings = Vec<(String, String)>;

/// A technique with settings.
#[derive(Clone)]
pub(super) struct Candidate {
    pub(super) technique: &'static dyn Technique,
    pub(super) settings: Settings,
}

impl Candidate {
    fn sets(&self, key: &str) -> bool {
        self.settings.iter().any(|(k, _)| k == key)
    }

    /// Technique and settings.
    pub(super) fn label(&self) -> String {
        let settings = self.settings.iter().map(|(k, v)| format!(" {k}={v}"));
        self.technique.name().to_owned() + &settings.collect::<String>()
    }
}

/// Parameters that say what is drawn and stored, or that leave the picture as it is.
const NOT_TUNED: [&str; 8] = [
    "light",
    "light-image",
    "light-frame",
    "shading",
    "color-format",
    "depth-format",
    "skip",
    "seed",
];

/// Each technique as it was given, and with each of its other parameters by itself at other
/// values.
pub(super) fn stars(techniques: &[Candidate]) -> Vec<Candidate> {
    techniques.iter().flat_map(star).collect()
}

fn star(given: &Candidate) -> Vec<Candidate> {
    let with = |name: &str, value: String| {
        let mut own = given.clone();
        own.settings.push((name.to_owned(), value));
        own
    };
    let mut all = vec![given.clone()];
    for info in given.technique.params() {
        if !NOT_TUNED.contains(&info.name) && !given.sets(info.name) {
            let values = values(info).into_iter();
            all.extend(values.map(|v| with(info.name, v)));
        }
    }
    all
}

/// Two of `kept` of one technique together, where they set different parameters.
pub(super) fn crosses(kept: &[Candidate]) -> Vec<Candidate> {
    let mut all: Vec<Candidate> = Vec::new();
    for (k, a) in kept.iter().enumerate() {
        for b in &kept[k + 1..] {
            let same = a.technique.name() == b.technique.name();
            let fresh: Settings = (b.settings.iter())
                .filter(|s| !a.settings.contains(s))
                .cloned()
                .collect();
            let clash = fresh.iter().any(|(key, _)| a.sets(key));
            let kept = a.settings.iter().any(|s| !b.settings.contains(s));
            if !same || clash || fresh.is_empty() || !kept {
                continue;
            }
            let mut both = a.clone();
            both.settings.extend(fresh);
            all.push(both);
        }
    }
    all
}

/// Values beside the default: all other names, and numbers around it.
fn values(info: &ParamInfo) -> Vec<String> {
    let numbers = match (info.domain, info.default) {
        (Domain::Words(words), _) => words.iter().map(|w| (*w).to_owned()).collect(),
        (Domain::Whole { kind, .. }, Value::Whole(n)) => around(kind, n),
        (Domain::Decimal { .. }, Value::Decimal(x)) => {
            vec![(0.5 * x).to_string(), (2.0 * x).to_string()]
        }
        _ => Vec::new(),
    };
    let default = info.default.to_string();
    let mut values: Vec<String> = Vec::new();
    for value in numbers {
        let taken = info.domain.takes(&value) && !info.domain.same(&value, &default);
        if taken && !values.contains(&value) {
            values.push(value);
        }
    }
    values
}

fn around(kind: Whole, n: u64) -> Vec<String> {
    let numbers = match kind {
        Whole::Square => {
            let side = n.isqrt();
            [side / 4, side / 2, 2 * side].map(|s| s * s).to_vec()
        }
        Whole::PowerOfTwo => vec![n / 4, n / 2, 2 * n, 4 * n],
        Whole::Any => vec![n / 2, n + 1, 2 * n],
    };
    numbers.iter().map(u64::to_string).collect()
}

#[cfg(test)]
mod tests {
    use gnomon_pipeline::technique::Params;
    use gnomon_pipeline::techniques;

    use super::*;

    #[test]
    fn every_candidate_is_taken_by_its_technique() {
        let plain = |t: &&'static dyn Technique| Candidate {
            technique: *t,
            settings: Settings::new(),
        };
        let plain: Vec<_> = techniques::all().iter().map(plain).collect();
        let all = stars(&plain);
        assert!(all.len() > 4 * techniques::all().len());
        for candidate in &all {
            let given = candidate.settings.iter().map(|(k, v)| format!("{k}={v}"));
            assert!(
                Params::parse(candidate.technique, given).is_ok(),
                "{}",
                candidate.label()
            );
            assert!(
                candidate
                    .settings
                    .iter()
                    .all(|s| !NOT_TUNED.contains(&s.0.as_str()))
            );
        }
        let of = |name: &str| -> Vec<String> {
            let own = all.iter().filter(|c| c.technique.name() == name);
            own.map(Candidate::label).collect()
        };
        assert!(of("ray-traced").contains(&"ray-traced samples=256".to_owned()));
        assert!(of("pcf").contains(&"pcf kernel=bicubic".to_owned()));
        assert_eq!(of("pcf")[0], "pcf");
    }

    /// What was given stays, whatever else is tried, alone or together.
    #[test]
    fn settings_that_were_given_stay() {
        let pair = |k: &str, v: &str| (k.to_owned(), v.to_owned());
        let given = Candidate {
            technique: techniques::find("pcf").unwrap(),
            settings: vec![pair("taps", "7")],
        };
        let all = stars(&[given]);
        assert!(all.len() > 3);
        let both = crosses(&all);
        assert!(both.iter().any(|c| c.settings.len() == 3));
        for candidate in all.iter().chain(&both) {
            let taps = candidate.settings.iter().filter(|s| s.0 == "taps");
            assert_eq!(taps.collect::<Vec<_>>(), [&pair("taps", "7")]);
        }
    }

    #[test]
    fn crosses_join_different_parameters_of_one_technique() {
        let pcf = techniques::find("pcf").unwrap();
        let pcss = techniques::find("pcss").unwrap();
        let of = |technique, settings: &[(&str, &str)]| Candidate {
            technique,
            settings: settings
                .iter()
                .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
                .collect(),
        };
        let kept = [
            of(pcf, &[]),
            of(pcf, &[("taps", "8")]),
            of(pcf, &[("taps", "2")]),
            of(pcf, &[("map-size", "256")]),
            of(pcss, &[("map-size", "256")]),
        ];
        let labels: Vec<String> = crosses(&kept).iter().map(Candidate::label).collect();
        assert_eq!(
            labels,
            ["pcf taps=8 map-size=256", "pcf taps=2 map-size=256"]
        );
    }
}
