//! CSV lists, read by column name, with the line of every mistake.

use crate::project::context::Context;
use crate::project::diagnostics::{Place, suggestion};
use crate::project::schema::At;

/// A table with the columns asked for.
pub struct Table {
    file: String,
    text: String,
    columns: &'static [&'static str],
    /// Line number and one cell per column; absent and empty cells are `None`.
    pub rows: Vec<Row>,
}

/// A row of a [`Table`].
pub struct Row {
    pub line: usize,
    pub cells: Vec<Option<String>>,
}

impl Table {
    /// Reads a file whose header names all `required` leading columns of `columns`.
    pub fn read(
        path: &At<String>,
        columns: &'static [&'static str],
        required: usize,
        context: &mut Context,
    ) -> Option<Self> {
        let text = context.read_text(path)?;
        let file = path.get_ref().clone();
        let before = context.diagnostics.len();
        let mut reader =
            csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
        let header = match reader.headers() {
            Ok(header) => header.clone(),
            Err(error) => {
                context.error_in(&file, &text, 1, error.to_string(), "");
                return None;
            }
        };
        let hint = format!("the header is {}", columns.join(","));
        for (index, name) in header.iter().enumerate() {
            if header.iter().take(index).any(|earlier| earlier == name) {
                context.error_in(&file, &text, 1, format!("a second column \"{name}\""), &hint);
            }
        }
        for name in header.iter().filter(|name| !columns.contains(name)) {
            let hint = suggestion(name, columns.iter().copied());
            let message = format!("unknown column \"{name}\"");
            context.error_in(&file, &text, 1, message, &hint);
        }
        for name in &columns[..required] {
            if !header.iter().any(|known| known == *name) {
                let message = format!("the column \"{name}\" is missing");
                context.error_in(&file, &text, 1, message, &hint);
            }
        }
        let of: Vec<Option<usize>> =
            columns.iter().map(|name| header.iter().position(|known| known == *name)).collect();
        let mut rows = Vec::new();
        for record in reader.records() {
            match record {
                Ok(record) => {
                    let line = record.position().map_or(0, |p| p.line() as usize);
                    let cell = |column: &Option<usize>| {
                        let cell = record.get((*column)?)?;
                        (!cell.is_empty()).then(|| cell.to_owned())
                    };
                    let cells = of.iter().map(cell).collect();
                    rows.push(Row { line, cells });
                }
                Err(error) => {
                    let line = error.position().map_or(1, |p| p.line() as usize);
                    let message = "the number of cells differs from the header's".to_owned();
                    context.error_in(&file, &text, line, message, &hint);
                    return None;
                }
            }
        }
        if rows.is_empty() && context.diagnostics.len() == before {
            context.error_in(&file, &text, 1, "the list is empty".to_owned(), "");
        }
        (context.diagnostics.len() == before).then_some(Self { file, text, columns, rows })
    }

    /// Reports a mistake in a row.
    pub fn error(&self, row: &Row, message: String, hint: &str, context: &mut Context) {
        context.error_in(&self.file, &self.text, row.line, message, hint);
    }

    /// The place of a row, for mistakes that only a later step can find.
    pub fn place(&self, row: &Row) -> Place {
        Place::line(&self.file, &self.text, row.line)
    }

    /// Warns of a row.
    pub fn warn(&self, row: &Row, message: String, hint: &str, context: &mut Context) {
        context.warn_in(&self.file, &self.text, row.line, message, hint);
    }

    /// A finite number, `None` where the cell is empty; `Err` after a reported mistake.
    pub fn number(&self, row: &Row, column: usize, context: &mut Context) -> Result<Option<f64>, ()> {
        let Some(cell) = &row.cells[column] else {
            return Ok(None);
        };
        match cell.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(Some(number)),
            Ok(_) | Err(_) => {
                let message = format!("{} must be a number, found \"{cell}\"", self.columns[column]);
                self.error(row, message, "decimals are written with a point", context);
                Err(())
            }
        }
    }

    /// A number that must be there.
    pub fn needed(&self, row: &Row, column: usize, context: &mut Context) -> Result<f64, ()> {
        if let Some(number) = self.number(row, column, context)? {
            return Ok(number);
        }
        let message = format!("{} is missing", self.columns[column]);
        self.error(row, message, "", context);
        Err(())
    }

    /// Three numbers in neighbouring columns.
    pub fn needed3(&self, row: &Row, column: usize, context: &mut Context) -> Result<[f64; 3], ()> {
        Ok([
            self.needed(row, column, context)?,
            self.needed(row, column + 1, context)?,
            self.needed(row, column + 2, context)?,
        ])
    }
}
