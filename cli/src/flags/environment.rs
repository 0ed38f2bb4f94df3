//! Flags of environment lighting.

use clap::{Args, ValueEnum};
use gnomon_pipeline::world::environment::{
    AmbientForm, FitSettings, LightForm, LightPlace, MapSettings, ResidualRule,
};
use gnomon_pipeline::world::scene::environment::EnvironmentRequest;

/// A map that lights the scene alone, and how lights are fitted to it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Environment lighting")]
pub(crate) struct EnvArgs {
    /// Light the scene by a map alone: sky (built in), a .hdr or .exr file
    /// (latitude-longitude, cross or strip), or a folder of px, nx, py, ny, pz, nz
    #[arg(long, value_name = "MAP")]
    pub(crate) env: Option<String>,
    /// Shape of the fitted area lights
    #[arg(long, value_name = "FORM", value_enum, requires = "env")]
    env_form: Option<FormArg>,
    /// A light grows where it gains more than this share of its energy [default:
    /// the largest with which the lights cover 95% of the map's light]
    #[arg(long, value_name = "T", requires = "env")]
    env_threshold: Option<f64>,
    /// What a light leaves in its texels, which becomes ambient light: excess (the
    /// face's mean where there was more) or mean (up to the face's mean)
    #[arg(long, value_name = "RULE", value_enum, requires = "env")]
    env_residual: Option<ResidualArg>,
    /// Where a light lies: texels (over those it took, as the paper has it), centroid
    /// (as large, about their luminance centroid) or moments (about it, and as large as
    /// their luminance is spread) [default: moments]
    #[arg(long, value_name = "PLACE", value_enum, requires = "env")]
    env_place: Option<PlaceArg>,
    /// What the lights leave: even (the same from everywhere, as the paper has it) or
    /// harmonic (spherical harmonics up to order 1) [default: harmonic]
    #[arg(long, value_name = "FORM", value_enum, requires = "env")]
    env_ambient: Option<AmbientArg>,
    /// Most texels along a face of the cube that the map is spread over [default: 128]
    #[arg(long, value_name = "N", requires = "env")]
    env_side: Option<usize>,
    /// Turn the map about the vertical, degrees
    #[arg(
        long,
        value_name = "DEGREES",
        requires = "env",
        allow_negative_numbers = true
    )]
    env_turn: Option<f64>,
    /// Factor of the map's radiance
    #[arg(long, value_name = "X", requires = "env")]
    env_brightness: Option<f64>,
}

/// Shape of fitted lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FormArg {
    Square,
    Rectangle,
}

/// What lights leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ResidualArg {
    Excess,
    Mean,
}

/// Where lights lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum PlaceArg {
    Texels,
    Centroid,
    Moments,
}

/// What lights leave is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum AmbientArg {
    Even,
    Harmonic,
}

impl EnvArgs {
    /// What is asked for with that many lights, if anything is.
    pub(crate) fn request(&self, lights: Option<usize>) -> Option<EnvironmentRequest> {
        let (map, fit) = (MapSettings::default(), FitSettings::default());
        Some(EnvironmentRequest {
            map: self.env.clone()?,
            folder: None,
            settings: MapSettings {
                side: self.env_side.unwrap_or(map.side),
                turn: self.env_turn.unwrap_or(map.turn),
                brightness: self.env_brightness.unwrap_or(map.brightness),
            },
            fit: FitSettings {
                lights: lights.unwrap_or(fit.lights),
                threshold: self.env_threshold,
                form: match self.env_form {
                    Some(FormArg::Square) => LightForm::Square,
                    Some(FormArg::Rectangle) => LightForm::Rectangle,
                    None => fit.form,
                },
                residual: match self.env_residual {
                    Some(ResidualArg::Excess) => ResidualRule::Excess,
                    Some(ResidualArg::Mean) => ResidualRule::Mean,
                    None => fit.residual,
                },
                place: match self.env_place {
                    Some(PlaceArg::Texels) => LightPlace::Texels,
                    Some(PlaceArg::Centroid) => LightPlace::Centroid,
                    Some(PlaceArg::Moments) => LightPlace::Moments,
                    None => fit.place,
                },
                ambient: match self.env_ambient {
                    Some(AmbientArg::Even) => AmbientForm::Even,
                    Some(AmbientArg::Harmonic) => AmbientForm::Harmonic,
                    None => fit.ambient,
                },
            },
        })
    }

    /// The flags as they were given.
    pub(crate) fn words(&self) -> Vec<String> {
        let given = [
            ("env", self.env.clone()),
            ("env-form", self.env_form.map(name)),
            ("env-threshold", self.env_threshold.map(|v| v.to_string())),
            ("env-residual", self.env_residual.map(name)),
            ("env-place", self.env_place.map(name)),
            ("env-ambient", self.env_ambient.map(name)),
            ("env-side", self.env_side.map(|v| v.to_string())),
            ("env-turn", self.env_turn.map(|v| v.to_string())),
            ("env-brightness", self.env_brightness.map(|v| v.to_string())),
        ];
        let word = |(flag, value): (&str, Option<String>)| Some(format!("--{flag}={}", value?));
        given.into_iter().filter_map(word).collect()
    }
}

/// A value as the command line has it.
fn name(value: impl ValueEnum) -> String {
    let name = value.to_possible_value();
    name.map_or(String::new(), |v| v.get_name().to_owned())
}
