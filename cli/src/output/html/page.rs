//! The page round everything: head, foot, styles and the one script.

use std::fmt::Write;

use super::super::tables::Table;
pub(crate) use super::escape;

/// A page of several sections.
pub(crate) struct Page {
    pub(crate) title: String,
    pub(crate) lead: String,
    /// Markup.
    pub(crate) body: String,
    /// How it was made: name and value.
    pub(crate) foot: Vec<(String, String)>,
}

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

impl Page {
    /// The page's text.
    pub(crate) fn to_html(&self) -> String {
        let title = escape(&self.title);
        let mut foot = String::new();
        for (name, value) in &self.foot {
            let _ = writeln!(foot, "<dt>{}</dt><dd>{}</dd>", escape(name), escape(value));
        }
        format!(
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>{title}</title>\n\
             <style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<p>{}</p>\n{}\
             <footer><dl>\n{foot}</dl></footer>\n<script>{SCRIPT}</script>\n</body>\n</html>\n",
            escape(&self.lead),
            self.body
        )
    }
}

/// A heading and sentences.
pub(crate) fn list(title: &str, lines: &[String]) -> String {
    let lines: String = lines
        .iter()
        .map(|l| format!("<li>{}</li>\n", escape(l)))
        .collect();
    format!(
        "<h3>{}</h3>\n<ul class=\"findings\">\n{lines}</ul>\n",
        escape(title)
    )
}

/// A heading and a table, which can be sorted where scripts run.
pub(crate) fn table(table: &Table) -> String {
    let head: String = table
        .header
        .iter()
        .map(|n| format!("<th scope=\"col\">{}</th>", escape(n)))
        .collect();
    let mut out = format!(
        "<h3>{}</h3>\n<div class=\"wide\"><table class=\"sortable\">\n<thead><tr>{head}</tr></thead>\n<tbody>\n",
        escape(&table.title)
    );
    for row in &table.rows {
        let cells: String = row
            .iter()
            .map(|c| format!("<td>{}</td>", escape(c.trim())))
            .collect();
        let _ = writeln!(out, "<tr>{cells}</tr>");
    }
    out + "</tbody></table></div>\n"
}
