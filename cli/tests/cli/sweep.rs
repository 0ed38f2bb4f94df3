//! `techniques --json` is enough to make a sweep: every value that it promises parses,
//! and none beyond.

use crate::common::Folder;
use gnomon_pipeline::technique::{Params, SETTING_WITHOUT_EFFECT};
use gnomon_pipeline::techniques::find;
use serde_json::Value;

fn techniques() -> Vec<Value> {
    let document = Folder::new("sweep").gnomon("techniques --json").json();
    document["techniques"].as_array().unwrap().clone()
}

fn params(technique: &Value) -> &[Value] {
    technique["params"].as_array().unwrap()
}

fn text(value: &Value) -> String {
    value
        .as_str()
        .map_or_else(|| value.to_string(), str::to_owned)
}

/// Values that the document promises: the default, all names, both ends and a number
/// in between.
fn promised(param: &Value) -> Vec<String> {
    let mut values = vec![text(&param["default"])];
    values.extend(param["choices"].as_array().unwrap().iter().map(text));
    let range = &param["range"];
    let (Some(min), max) = (range["min"].as_f64(), range["max"].as_f64()) else {
        return values;
    };
    let max = max.unwrap_or(1000.0);
    match param["type"].as_str().unwrap() {
        "whole" => values.extend([min, ((min + max) / 2.0).floor(), max].map(|n| n.to_string())),
        "power-of-two" => {
            let powers = (0..32).map(|k| f64::from(1u32 << k));
            let within = powers.filter(|n| (min..=max).contains(n));
            values.extend(within.map(|n| n.to_string()));
        }
        "square" => {
            let squares = (0..=64).map(|n| f64::from(n * n));
            let within = squares.filter(|n| (min..=max).contains(n));
            values.extend(within.map(|n| n.to_string()));
        }
        "decimal" => {
            values.extend([min + 0.25, max].map(|x| x.to_string()));
            if range["min_included"] == Value::Bool(true) {
                values.push(min.to_string());
            }
        }
        "list" => values.extend(["0".to_owned(), "3+1".to_owned()]),
        other => panic!("numbers of type {other}"),
    }
    values
}

/// Values just beyond.
fn beyond(param: &Value) -> Vec<String> {
    let range = &param["range"];
    let mut values = vec!["no-such-value-of-it".to_owned()];
    if let Some(min) = range["min"].as_f64() {
        values.push((min - 1.0).to_string());
        if range["min_included"] == Value::Bool(false) {
            values.push(min.to_string());
        }
    }
    if let Some(max) = range["max"].as_f64() {
        values.push((max + 1.0).to_string());
    }
    values
}

#[test]
fn every_promised_value_parses_and_none_beyond() {
    let mut settings = 0;
    for technique in techniques() {
        let name = technique["name"].as_str().unwrap();
        let found = find(name).unwrap();
        let takes = |setting: &str| Params::parse(found, [setting]).is_ok();
        for param in params(&technique) {
            let key = param["name"].as_str().unwrap();
            for value in promised(param) {
                assert!(takes(&format!("{key}={value}")), "{name} {key}={value}");
                settings += 1;
            }
            if param["type"] == "technique" {
                continue; // judged when it draws
            }
            for value in beyond(param) {
                assert!(!takes(&format!("{key}={value}")), "{name} {key}={value}");
            }
        }
    }
    assert!(settings > 500, "{settings}");
}

/// Every condition names parameters of the same technique, and values that they take.
#[test]
fn conditions_can_be_evaluated() {
    fn check(condition: &Value, technique: &str) {
        let found = find(technique).unwrap();
        for list in ["all", "any"] {
            let inner = condition[list].as_array();
            inner
                .into_iter()
                .flatten()
                .for_each(|c| check(c, technique));
        }
        let Some(param) = condition["param"].as_str() else {
            assert!(
                condition["all"].is_array()
                    || condition["any"].is_array()
                    || condition["a_light_is"].is_string()
                    || condition["scene_has"].is_string()
            );
            return;
        };
        let values = condition["is"]
            .as_array()
            .or(condition["is_not"].as_array());
        for value in values.unwrap() {
            let setting = format!("{param}={}", text(value));
            assert!(Params::parse(found, [&setting]).is_ok(), "{setting}");
        }
    }
    let mut conditions = 0;
    for technique in techniques() {
        let with = params(&technique).iter().map(|p| &p["applies_when"]);
        for condition in with.filter(|c| !c.is_null()) {
            check(condition, technique["name"].as_str().unwrap());
            conditions += 1;
        }
    }
    assert!(conditions > 20, "{conditions}");
}

#[test]
fn capabilities_are_those_of_the_techniques() {
    for technique in techniques() {
        let capabilities = &technique["capabilities"];
        let found = find(technique["name"].as_str().unwrap()).unwrap();
        let wedges = capabilities["wedges"] != "none";
        assert_eq!(wedges, found.capabilities().has_wedges());
        assert!(!capabilities["lights"].as_array().unwrap().is_empty());
        let open_casters = params(&technique)
            .iter()
            .any(|p| p["name"] == "open-casters");
        assert_eq!(
            capabilities["needs_closed_casters"],
            Value::Bool(open_casters)
        );
    }
}

#[test]
fn settings_without_effect_are_reported_in_both_verbs() {
    let folder = Folder::new("without-effect");
    let codes = |warnings: &Value| -> Vec<String> {
        let all = warnings.as_array().unwrap().iter();
        all.map(|w| w["code"].as_str().unwrap().to_owned())
            .collect()
    };
    let render = "render cylinder --size 32x24 --json --out a.png --technique pcf \
                  --set kernel=bicubic --set taps=9";
    let document = folder.gnomon(render).json();
    assert_eq!(codes(&document["warnings"]), [SETTING_WITHOUT_EFFECT]);
    let compare = "compare cylinder --size 32x24 --json --out-dir . \
                   --techniques pcf:kernel=bicubic:taps=9";
    let document = folder.gnomon(compare).json();
    let warnings = &document["results"][0]["warnings"];
    assert_eq!(codes(warnings), [SETTING_WITHOUT_EFFECT], "{warnings}");
}

#[test]
fn settings_that_rule_each_other_out_are_bad_input() {
    let folder = Folder::new("ruled-out");
    folder
        .gnomon(
            "render cylinder --size 32x24 --technique soft-shadow-volumes \
             --set copy-back=on --set buffer=rgba8x2",
        )
        .refused(&["copy-back=on", "buffer=rgba8x2"]);
}
