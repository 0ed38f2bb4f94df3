//! Reading a profile's file: every value says where it is from.

use serde::Serialize;
use toml::{Table, Value};

use super::ProfileError;

/// A value of a profile and where it is from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Fact {
    /// Table and key, as `zs.cache.sets`.
    pub key: String,
    /// The value, as TOML writes it.
    pub value: String,
    /// Where it can be read up.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Why it was chosen where no source is known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub assumption: Option<String>,
}

/// The facts of a file, taken one by one.
pub(super) struct Facts<'a> {
    file: &'a str,
    left: Vec<Entry>,
    /// Those that were taken.
    pub(super) taken: Vec<Fact>,
}

struct Entry {
    fact: Fact,
    value: Value,
}

impl<'a> Facts<'a> {
    pub(super) fn read(file: &'a str, text: &str) -> Result<Self, ProfileError> {
        let table: Table = text.parse().map_err(|e: toml::de::Error| {
            let (file, error) = (file.to_owned(), e.to_string());
            ProfileError::Syntax { file, error }
        })?;
        let mut facts = Self {
            file,
            left: Vec::new(),
            taken: Vec::new(),
        };
        facts.gather("", &table)?;
        Ok(facts)
    }

    fn gather(&mut self, prefix: &str, table: &Table) -> Result<(), ProfileError> {
        for (key, value) in table {
            let key = match prefix {
                "" => key.clone(),
                _ => format!("{prefix}.{key}"),
            };
            match value {
                Value::Table(t) if t.contains_key("value") => {
                    let fact = self.fact(&key, t)?;
                    let value = t["value"].clone();
                    self.left.push(Entry { fact, value });
                }
                Value::Table(t) => self.gather(&key, t)?,
                _ => return Err(self.wrong(&key, &value.to_string(), SHAPE)),
            }
        }
        Ok(())
    }

    fn fact(&self, key: &str, table: &Table) -> Result<Fact, ProfileError> {
        let text = |name: &str| match table.get(name) {
            Some(Value::String(s)) if !s.trim().is_empty() => Ok(Some(s.clone())),
            Some(other) => Err(self.wrong(&format!("{key}.{name}"), &other.to_string(), "a text")),
            None => Ok(None),
        };
        let (source, assumption) = (text("source")?, text("assumption")?);
        if table.len() != 2 || source.is_some() == assumption.is_some() {
            return Err(self.wrong(key, &Value::Table(table.clone()).to_string(), SHAPE));
        }
        Ok(Fact {
            key: key.to_owned(),
            value: table["value"].to_string(),
            source,
            assumption,
        })
    }

    fn wrong(&self, key: &str, given: &str, valid: &str) -> ProfileError {
        ProfileError::Value {
            file: self.file.to_owned(),
            key: key.to_owned(),
            given: given.to_owned(),
            valid: valid.to_owned(),
        }
    }

    fn take(&mut self, key: &str, valid: &str) -> Result<Value, ProfileError> {
        let Some(at) = self.left.iter().position(|e| e.fact.key == key) else {
            return Err(ProfileError::Missing {
                file: self.file.to_owned(),
                key: key.to_owned(),
                valid: valid.to_owned(),
            });
        };
        let entry = self.left.remove(at);
        self.taken.push(entry.fact);
        Ok(entry.value)
    }

    /// A number of `range`.
    pub(super) fn number(
        &mut self,
        key: &str,
        range: core::ops::RangeInclusive<u32>,
    ) -> Result<u32, ProfileError> {
        let valid = format!("a whole number from {} to {}", range.start(), range.end());
        let value = self.take(key, &valid)?;
        let number = value.as_integer().and_then(|n| u32::try_from(n).ok());
        let number = number.filter(|n| range.contains(n));
        number.ok_or_else(|| self.wrong(key, &value.to_string(), &valid))
    }

    /// A switch.
    pub(super) fn switch(&mut self, key: &str) -> Result<bool, ProfileError> {
        let value = self.take(key, "true or false")?;
        let switch = value.as_bool();
        switch.ok_or_else(|| self.wrong(key, &value.to_string(), "true or false"))
    }

    /// One of the names of `choices`.
    pub(super) fn choice<T: Copy>(
        &mut self,
        key: &str,
        choices: &[(&str, T)],
    ) -> Result<T, ProfileError> {
        let names: Vec<String> = choices.iter().map(|(n, _)| format!("\"{n}\"")).collect();
        let valid = format!("one of {}", names.join(", "));
        let value = self.take(key, &valid)?;
        let found = value.as_str();
        let found = found.and_then(|v| choices.iter().find(|(n, _)| *n == v));
        found
            .map(|(_, t)| *t)
            .ok_or_else(|| self.wrong(key, &value.to_string(), &valid))
    }

    /// Free text.
    pub(super) fn text(&mut self, key: &str) -> Result<String, ProfileError> {
        let value = self.take(key, "a text")?;
        let text = value.as_str().map(str::to_owned);
        text.ok_or_else(|| self.wrong(key, &value.to_string(), "a text"))
    }

    /// Nothing may be left.
    pub(super) fn finish(self) -> Result<Vec<Fact>, ProfileError> {
        match self.left.first() {
            None => Ok(self.taken),
            Some(entry) => Err(ProfileError::Unknown {
                file: self.file.to_owned(),
                key: entry.fact.key.clone(),
                valid: self
                    .taken
                    .iter()
                    .map(|f| f.key.as_str())
                    .collect::<Vec<_>>()
                    .join(", "),
            }),
        }
    }
}

const SHAPE: &str =
    "{ value = …, source = \"where it can be read\" } or { value = …, assumption = \"why\" }";
