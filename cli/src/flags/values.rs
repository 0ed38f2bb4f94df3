//! Values that flags of several verbs take.

use gnomon_raster::MAX_TEXTURE_SIZE;

/// Width and height in pixels.
pub(crate) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let valid =
        format!("expected WIDTHxHEIGHT in pixels, each 1 to {MAX_TEXTURE_SIZE}, such as 800x600");
    let sides = text.split_once(['x', 'X']).ok_or(&valid)?;
    let side = |s: &str| match s.parse::<u32>() {
        Ok(n) if (1..=MAX_TEXTURE_SIZE).contains(&n) => Ok(n),
        _ => Err(format!("`{s}` is no valid side; {valid}")),
    };
    Ok([side(sides.0)?, side(sides.1)?])
}

/// Key and value of a parameter, unchecked.
pub(crate) fn parse_setting(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((key, value)) if !key.is_empty() => Ok((key.to_owned(), value.to_owned())),
        _ => Err("expected KEY=VALUE, such as method=zfail".to_owned()),
    }
}

/// A time of an animation in seconds.
pub(crate) fn parse_time(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds.is_finite() => Ok(seconds),
        _ => Err("expected a finite number of seconds".to_owned()),
    }
}

/// Frames per second.
pub(crate) fn parse_rate(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(rate) if rate.is_finite() && rate > 0.0 => Ok(rate),
        _ => Err("expected a number of frames per second above 0".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked() {
        assert_eq!(parse_size("800x600"), Ok([800, 600]));
        assert_eq!(parse_size("1X8192"), Ok([1, 8192]));
        for bad in ["", "800", "0x0", "8193x1", "-1x2", "axb", "1x2x3", "1.5x2"] {
            let message = parse_size(bad).unwrap_err();
            assert!(message.contains("WIDTHxHEIGHT"), "{bad}: {message}");
        }
    }

    #[test]
    fn settings_keep_further_equals_signs() {
        let pair = parse_setting("a=b=c").unwrap();
        assert_eq!(pair, ("a".to_owned(), "b=c".to_owned()));
        assert!(parse_setting("a").is_err() && parse_setting("=b").is_err());
    }
}
