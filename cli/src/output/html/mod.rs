//! Pages that stand alone: pictures as data URIs, nothing fetched.

pub(crate) mod bars;
pub(crate) mod draws;
pub(crate) mod frame;
pub(crate) mod history;
pub(crate) mod maps;
pub(crate) mod page;
pub(crate) mod scatter;

use std::fmt::Write;

use super::tables::Table;

/// A picture with its caption.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    pub(crate) name: String,
    pub(crate) caption: String,
    /// The PNG file.
    pub(crate) png: Vec<u8>,
}

/// A page.
pub(crate) struct Report<'a> {
    pub(crate) title: String,
    /// One line below the title.
    pub(crate) lead: String,
    pub(crate) figures: &'a [Figure],
    pub(crate) tables: &'a [Table],
    pub(crate) notes: &'a [String],
}

impl Report<'_> {
    /// The page's text.
    pub(crate) fn to_html(&self) -> String {
        let title = escape(&self.title);
        let figures: String = self.figures.iter().map(figure).collect();
        let tables: String = self.tables.iter().map(table).collect();
        let notes: String = self
            .notes
            .iter()
            .map(|n| format!("<li>{}</li>\n", escape(n)))
            .collect();
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n\
             <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<p>{}</p>\n\
             <div class=\"figures\">\n{figures}</div>\n{tables}<ul>\n{notes}</ul>\n</body>\n</html>\n",
            escape(&self.lead)
        )
    }
}

const STYLE: &str = include_str!("report.css");

fn figure(figure: &Figure) -> String {
    format!(
        "<figure id=\"{0}\"><a href=\"#{0}\" title=\"Enlarge\">\
         <img alt=\"{0}\" src=\"data:image/png;base64,{1}\"></a>\
         <figcaption><b>{0}</b> {2}</figcaption></figure>\n",
        escape(&figure.name),
        base64(&figure.png),
        escape(&figure.caption)
    )
}

fn table(table: &Table) -> String {
    let mut out = format!(
        "<h2>{}</h2>\n<div class=\"wide\"><table>\n<tr>",
        escape(&table.title)
    );
    for name in &table.header {
        let _ = write!(out, "<th>{}</th>", escape(name));
    }
    out += "</tr>\n";
    for row in &table.rows {
        out += &self::row(row, table.header.len());
    }
    out + "</table></div>\n"
}

fn row(cells: &[String], columns: usize) -> String {
    if let [heading] = cells {
        return format!(
            "<tr class=\"heading\"><td colspan=\"{columns}\">{}</td></tr>\n",
            escape(heading)
        );
    }
    let cells: String = cells
        .iter()
        .map(|c| format!("<td>{}</td>", escape(c.trim())))
        .collect();
    format!("<tr>{cells}</tr>\n")
}

pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// RFC 4648, with padding.
pub(crate) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = chunk
            .iter()
            .enumerate()
            .fold(0u32, |w, (i, b)| w | u32::from(*b) << (16 - 8 * i));
        for digit in 0..4 {
            let value = (word >> (18 - 6 * digit)) as usize & 63;
            out.push(if digit <= chunk.len() {
                DIGITS[value] as char
            } else {
                '='
            });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_has_the_standards_values() {
        let encoded =
            ["", "f", "fo", "foo", "foob", "fooba", "foobar"].map(|s| base64(s.as_bytes()));
        assert_eq!(
            encoded,
            [
                "", "Zg==", "Zm8=", "Zm9v", "Zm9vYg==", "Zm9vYmE=", "Zm9vYmFy"
            ]
        );
    }

    #[test]
    fn text_cannot_become_markup() {
        let report = Report {
            title: "<b>&\"".to_owned(),
            lead: String::new(),
            figures: &[],
            tables: &[Table {
                title: "t".to_owned(),
                header: ["a", "b"].map(str::to_owned).to_vec(),
                rows: vec![vec!["<i>".to_owned()]],
            }],
            notes: &["<script>".to_owned()],
        };
        let html = report.to_html();
        assert!(html.contains("&lt;b&gt;&amp;&quot;") && html.contains("colspan=\"2\""));
        assert!(!html.contains("<script") && !html.contains("<i>"));
    }
}
