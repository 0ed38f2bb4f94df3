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

/// Each technique at its defaults, and with each parameter by itself at other values.
pub(super) fn stars(techniques: &[&'static dyn Technique]) -> Vec<Candidate> {
    techniques.iter().flat_map(|t| star(*t)).collect()
}

fn star(technique: &'static dyn Technique) -> Vec<Candidate> {
    let with = |settings| Candidate {
        technique,
        settings,
    };
    let mut all = vec![with(Settings::new())];
    for info in technique.params() {
        if NOT_TUNED.contains(&info.name) {
            continue;
        }
        let values = values(info).into_iter();
        all.extend(values.map(|v| with(vec![(info.name.to_owned(), v)])));
    }
    all
}

/// Two of `kept` of one technique together, where they set different parameters.
pub(super) fn crosses(kept: &[Candidate]) -> Vec<Candidate> {
    let mut all: Vec<Candidate> = Vec::new();
    for (k, a) in kept.iter().enumerate() {
        for b in &kept[k + 1..] {
            let same = a.technique.name() == b.technique.name();
            let clash = b
                .settings
                .iter()
                .any(|(key, _)| a.settings.iter().any(|s| s.0 == *key));
            if !same || clash || a.settings.is_empty() || b.settings.is_empty() {
                continue;
            }
            let both = a.settings.iter().chain(&b.settings).cloned().collect();
            all.push(Candidate {
                technique: a.technique,
                settings: both,
            });
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
        let all = stars(techniques::all());
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
