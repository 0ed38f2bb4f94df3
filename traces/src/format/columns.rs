//! Columns: what repeats in neighbouring records lies side by side and packs well.
//!
//! A table is `u64 records | u32 columns | columns × u64 bytes | the columns`. Numbers are
//! LEB128 (seven bits a byte, low first), differences zigzag.

/// Columns that are written to.
pub(crate) struct Writer {
    records: u64,
    columns: Vec<Vec<u8>>,
}

impl Writer {
    pub(crate) fn new(columns: usize) -> Self {
        Self {
            records: 0,
            columns: vec![Vec::new(); columns],
        }
    }

    /// One more record follows.
    pub(crate) fn begin(&mut self) {
        self.records += 1;
    }

    #[inline]
    pub(crate) fn byte(&mut self, column: usize, byte: u8) {
        self.columns[column].push(byte);
    }

    #[inline]
    pub(crate) fn number(&mut self, column: usize, mut n: u64) {
        let to = &mut self.columns[column];
        // Nearly all are below 128.
        while n >= 0x80 {
            to.push(n as u8 | 0x80);
            n >>= 7;
        }
        to.push(n as u8);
    }

    /// `to` as its difference from `from`.
    #[inline]
    pub(crate) fn difference(&mut self, column: usize, from: u64, to: u64) {
        let d = to.wrapping_sub(from) as i64;
        self.number(column, (d << 1 ^ d >> 63) as u64);
    }

    /// Eight bytes.
    pub(crate) fn mask(&mut self, column: usize, mask: u64) {
        self.columns[column].extend_from_slice(&mask.to_le_bytes());
    }

    pub(crate) fn finish(self) -> Vec<u8> {
        let size = self.columns.iter().map(|c| 8 + c.len()).sum::<usize>();
        let mut data = Vec::with_capacity(12 + size);
        data.extend(self.records.to_le_bytes());
        data.extend((self.columns.len() as u32).to_le_bytes());
        for column in &self.columns {
            data.extend((column.len() as u64).to_le_bytes());
        }
        for column in &self.columns {
            data.extend_from_slice(column);
        }
        data
    }
}

/// How many records a table says that it has, which is written first.
pub(crate) fn records(start: [u8; 8]) -> u64 {
    u64::from_le_bytes(start)
}

/// Columns that are read from.
#[derive(Clone, Debug)]
pub(crate) struct Reader<'a> {
    records: u64,
    columns: Vec<&'a [u8]>,
}

impl<'a> Reader<'a> {
    /// The table of `data`, which has that many columns; each record takes a byte or more
    /// of the first.
    pub(crate) fn new(data: &'a [u8], columns: usize) -> Result<Self, String> {
        let short = || format!("{} bytes are no table of {columns} columns", data.len());
        let (records, rest) = data.split_first_chunk().ok_or_else(short)?;
        let (count, rest) = rest.split_first_chunk().ok_or_else(short)?;
        let count = u32::from_le_bytes(*count) as usize;
        if count != columns {
            return Err(format!("it has {count} columns, {columns} are known"));
        }
        let (sizes, mut rest) = rest.split_at_checked(8 * columns).ok_or_else(short)?;
        let mut reader = Self {
            records: self::records(*records),
            columns: Vec::with_capacity(columns),
        };
        for size in sizes.as_chunks().0 {
            let size = usize::try_from(u64::from_le_bytes(*size));
            let size = size.map_err(|e| e.to_string())?;
            let (column, left) = rest.split_at_checked(size).ok_or_else(short)?;
            reader.columns.push(column);
            rest = left;
        }
        if !rest.is_empty() || reader.records > reader.columns[0].len() as u64 {
            return Err(short());
        }
        Ok(reader)
    }

    pub(crate) fn records(&self) -> u64 {
        self.records
    }

    pub(crate) fn byte(&mut self, column: usize) -> Result<u8, String> {
        let (byte, rest) = self.columns[column]
            .split_first()
            .ok_or_else(|| ended(column))?;
        self.columns[column] = rest;
        Ok(*byte)
    }

    pub(crate) fn number(&mut self, column: usize) -> Result<u64, String> {
        let mut n = 0;
        for shift in (0..70).step_by(7) {
            let byte = self.byte(column)?;
            n |= u64::from(byte & 0x7f).checked_shl(shift).unwrap_or(0);
            if byte < 0x80 {
                return Ok(n);
            }
        }
        Err(format!(
            "a number of column {column} is longer than 64 bits"
        ))
    }

    /// A number that fits in fewer bits.
    pub(crate) fn small<T: TryFrom<u64>>(&mut self, column: usize) -> Result<T, String> {
        narrow(column, self.number(column)?)
    }

    /// What differs from `from` by the next number.
    pub(crate) fn difference<T: TryFrom<u64>>(
        &mut self,
        column: usize,
        from: u64,
    ) -> Result<T, String> {
        let z = self.number(column)?;
        let d = z >> 1 ^ (z & 1).wrapping_neg();
        narrow(column, from.wrapping_add(d))
    }

    pub(crate) fn mask(&mut self, column: usize) -> Result<u64, String> {
        let (mask, rest) = self.columns[column]
            .split_first_chunk()
            .ok_or_else(|| ended(column))?;
        self.columns[column] = rest;
        Ok(u64::from_le_bytes(*mask))
    }

    /// Nothing is left.
    pub(crate) fn finish(&self) -> Result<(), String> {
        match self.columns.iter().position(|c| !c.is_empty()) {
            None => Ok(()),
            Some(i) => Err(format!(
                "{} bytes of column {i} are left over",
                self.columns[i].len()
            )),
        }
    }
}

fn ended(column: usize) -> String {
    format!("column {column} ends too early")
}

fn narrow<T: TryFrom<u64>>(column: usize, n: u64) -> Result<T, String> {
    T::try_from(n).map_err(|_| format!("{n} in column {column} is too large"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back() {
        let numbers = [0, 1, 127, 128, 1 << 31, u64::MAX, u64::MAX >> 1];
        let mut w = Writer::new(3);
        for (i, n) in numbers.into_iter().enumerate() {
            w.begin();
            w.number(0, n);
            w.difference(1, numbers[(i + 3) % 7], n);
            w.mask(2, n);
        }
        let data = w.finish();
        let mut r = Reader::new(&data, 3).unwrap();
        assert_eq!(r.records(), 7);
        for (i, n) in numbers.into_iter().enumerate() {
            assert_eq!(r.number(0), Ok(n));
            assert_eq!(r.difference(1, numbers[(i + 3) % 7]), Ok(n));
            assert!(r.finish().is_err());
            assert_eq!(r.mask(2), Ok(n));
        }
        r.finish().unwrap();
        assert!(r.byte(0).is_err() && r.mask(1).is_err());
    }

    #[test]
    fn tables_that_lie_are_refused() {
        let mut w = Writer::new(2);
        w.begin();
        w.byte(0, 0xff);
        let data = w.finish();
        assert!(Reader::new(&data, 3).is_err());
        assert!(Reader::new(&data, 2).unwrap().number(0).is_err());
        for at in 0..data.len() - 1 {
            let mut bad = data.clone();
            bad[at] = 0xff;
            assert!(Reader::new(&bad, 2).is_err(), "byte {at}");
            assert!(Reader::new(&data[..at], 2).is_err());
        }
        let mut w = Writer::new(1);
        (0..11).for_each(|_| w.byte(0, 0xff));
        let data = w.finish();
        let long = Reader::new(&data, 1).unwrap().number(0).unwrap_err();
        assert_eq!(long, "a number of column 0 is longer than 64 bits");
    }
}
