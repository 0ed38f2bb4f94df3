//! What `--show` asks for: `BUFFER[@PASS[/DRAW]][=FILE]`.

use std::path::{Path, PathBuf};

use crate::error::CliError;
use crate::output::files::check_target;
use crate::verbs::file_stem;

/// A buffer, a moment, a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ShowRequest {
    /// As given, without the file.
    pub(super) text: String,
    /// Label or number of a texture, with mip level and layer, depth or stencil behind it.
    pub(super) buffer: String,
    /// Label or number of a pass; the end of the frame where there is none.
    pub(super) pass: Option<String>,
    /// Label or number of a draw of it.
    pub(super) draw: Option<String>,
    file: Option<PathBuf>,
}

/// How values are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Png,
    Exr,
    Npy,
}

impl ShowRequest {
    /// Reads the flag's value.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let (what, file) = match text.split_once('=') {
            Some((what, file)) => (what, Some(PathBuf::from(file))),
            None => (text, None),
        };
        let (buffer, moment) = match what.split_once('@') {
            Some((buffer, moment)) => (buffer, Some(moment)),
            None => (what, None),
        };
        let (pass, draw) = match moment.map(|m| m.split_once('/').ok_or(m)) {
            Some(Ok((pass, draw))) => (Some(pass), Some(draw)),
            Some(Err(pass)) => (Some(pass), None),
            None => (None, None),
        };
        if [Some(buffer), pass, draw].contains(&Some("")) {
            return Err(VALID.to_owned());
        }
        if file.as_deref().is_some_and(|f| kind_of(f).is_none()) {
            return Err("expected a file name that ends in .png, .exr or .npy".to_owned());
        }
        Ok(Self {
            text: what.to_owned(),
            buffer: buffer.to_owned(),
            pass: pass.map(str::to_owned),
            draw: draw.map(str::to_owned),
            file,
        })
    }

    /// As given, without the file.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Whether a file was named.
    pub(crate) fn has_file(&self) -> bool {
        self.file.is_some()
    }

    pub(super) fn kind(&self) -> Kind {
        self.file.as_deref().and_then(kind_of).unwrap_or(Kind::Png)
    }

    /// The file that was named, or one beside the render at `out`.
    pub(crate) fn path(&self, out: &Path) -> Result<PathBuf, CliError> {
        let path = self.file.clone().unwrap_or_else(|| {
            let mut name = out.file_stem().unwrap_or_default().to_owned();
            name.push(format!("-{}.png", file_stem(&self.text)));
            out.with_file_name(name)
        });
        check_target(&path)?;
        Ok(path)
    }
}

const VALID: &str = "expected BUFFER, BUFFER@PASS or BUFFER@PASS/DRAW, each a label or a number, \
                     and =FILE.png, .exr or .npy behind it if need be";

fn kind_of(file: &Path) -> Option<Kind> {
    match file.extension()?.to_str()? {
        "png" => Some(Kind::Png),
        "exr" => Some(Kind::Exr),
        "npy" => Some(Kind::Npy),
        _ => None,
    }
}

/// The error of a request that names what is not there.
pub(super) fn refuse(request: &ShowRequest, valid: String) -> CliError {
    CliError::Flag {
        flag: "--show",
        value: request.text.clone(),
        valid,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_and_files_are_read() {
        let read = |text| ShowRequest::parse(text).unwrap();
        let all = read("depth-stencil.stencil@volumes/2 knot=a/b.npy");
        assert_eq!(all.buffer, "depth-stencil.stencil");
        assert_eq!(all.pass.as_deref(), Some("volumes"));
        assert_eq!(all.draw.as_deref(), Some("2 knot"));
        assert_eq!(all.kind(), Kind::Npy);
        assert_eq!(all.path(Path::new("x.png")).unwrap(), Path::new("a/b.npy"));
        let plain = read("color");
        assert_eq!((plain.pass.clone(), plain.kind()), (None, Kind::Png));
        let beside = plain.path(Path::new("out/x.png")).unwrap();
        assert_eq!(beside, Path::new("out/x-color.png"));
    }

    #[test]
    fn nonsense_is_refused() {
        for text in [
            "",
            "@volumes",
            "color@",
            "color@a/",
            "color=a.tiff",
            "color=",
        ] {
            assert!(ShowRequest::parse(text).is_err(), "{text}");
        }
    }
}
