//! A file: its first bytes, sections, an index of them, and a footer that finds it.
//!
//! Reading goes through the sections forwards and needs neither index nor footer: where
//! a file was cut short, all that lies before the cut is there.

use super::section::{Codec, Entry, HEADER, Section};
use crate::error::TraceError;

/// As in PNG: a copy in text mode breaks it, and it is no text.
pub(crate) const MAGIC: [u8; 8] = *b"\x89GNT\r\n\x1a\n";
pub(crate) const MAJOR: u16 = 1;
pub(crate) const MINOR: u16 = 0;
/// Magic, versions, zeros.
const START: usize = 16;
const INDEX: [u8; 4] = *b"INDX";

/// The bytes of a file of packed sections, in their order.
pub(crate) fn assemble<'a>(sections: impl IntoIterator<Item = &'a [u8]>) -> Vec<u8> {
    let mut file = MAGIC.to_vec();
    file.extend(MAJOR.to_le_bytes());
    file.extend(MINOR.to_le_bytes());
    file.resize(START, 0);
    let mut index = Vec::new();
    for section in sections {
        index.extend((file.len() as u64).to_le_bytes());
        // The header says all that the index needs.
        index.extend_from_slice(&section[..HEADER]);
        file.extend_from_slice(section);
    }
    let at = file.len() as u64;
    let section = Section {
        tag: INDEX,
        version: 1,
        frame: 0,
        part: 0,
        data: index,
    };
    file.extend(section.pack(Codec::Raw));
    file.extend(at.to_le_bytes());
    file.extend(MAGIC);
    file
}

/// The sections of a file, and what is wrong with its end.
#[derive(Clone, Debug)]
pub(crate) struct Contents {
    pub(crate) entries: Vec<Entry>,
    /// Why the file's end is not there, if it is not.
    pub(crate) lost: Option<String>,
}

/// Finds the sections of `file`. None is unpacked, all have their hashes.
pub(crate) fn read(file: &[u8]) -> Result<Contents, TraceError> {
    check_start(file)?;
    let mut entries = Vec::new();
    let mut at = START;
    while let Some(entry) = Entry::at(file, at) {
        entry.check(file)?;
        at = entry.end().expect("checked with the header");
        if entry.tag == INDEX {
            let lost = index_faults(file, &entry, &entries, at)?;
            return Ok(Contents { entries, lost });
        }
        entries.push(entry);
    }
    if file.ends_with(&MAGIC) && file.len() > at {
        let footer = file[at..].first_chunk().map(|b| u64::from_le_bytes(*b));
        if let Some(index) = entries.iter().find(|e| Some(e.offset) == footer) {
            return Err(index.wrong("the footer says that it is the index, its tag does not"));
        }
        return Err(TraceError::Section {
            tag: "????".to_owned(),
            offset: at as u64,
            reason: "its header is damaged: tag, zeros or sizes cannot be right".to_owned(),
        });
    }
    let lost = Some(format!(
        "the file ends at byte {}, in what begins at byte {at}; that and all behind it is lost",
        file.len()
    ));
    Ok(Contents { entries, lost })
}

fn check_start(file: &[u8]) -> Result<(), TraceError> {
    let not = |reason: String| Err(TraceError::NotATrace { reason });
    let Some(start) = file.get(..START) else {
        return not(format!("it has {} bytes", file.len()));
    };
    if start[..8] != MAGIC {
        return not(format!("it begins with {:02X?}", &start[..8]));
    }
    let version = |at: usize| u16::from_le_bytes([start[at], start[at + 1]]);
    if version(8) != MAJOR {
        return Err(TraceError::Format {
            major: version(8),
            minor: version(10),
            known: MAJOR,
        });
    }
    if start[12..] != [0; 4] {
        return not("bytes 12 to 15 are not zero".to_owned());
    }
    Ok(())
}

/// Whether the index lists `entries`, and the footer points at it.
fn index_faults(
    file: &[u8],
    index: &Entry,
    entries: &[Entry],
    end: usize,
) -> Result<Option<String>, TraceError> {
    if (index.version, index.frame, index.part) != (1, 0, 0) {
        return Err(index.wrong("an index has version 1, frame 0 and part 0"));
    }
    let listed = index.unpack(file)?.data;
    let (listed, rest) = listed.as_chunks::<{ 8 + HEADER }>();
    for (entry, listed) in entries.iter().zip(listed) {
        let at = entry.offset as usize;
        if listed[..8] != entry.offset.to_le_bytes() || listed[8..] != file[at..at + HEADER] {
            return Err(entry.wrong("its header is not the one that the index lists"));
        }
    }
    if listed.len() != entries.len() || !rest.is_empty() {
        return Err(index.wrong("it does not list the sections that are there"));
    }
    let footer = index.offset.to_le_bytes().into_iter().chain(MAGIC);
    if file[end..].iter().copied().eq(footer) {
        return Ok(None);
    }
    match file.len() < end + 16 {
        true => Ok(Some(format!("the footer at byte {end} is cut off"))),
        false => Err(TraceError::Section {
            tag: "footer".to_owned(),
            offset: end as u64,
            reason: "it is not 16 bytes that point at the index".to_owned(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sections() -> Vec<Section> {
        let section = |tag: &[u8; 4], frame, data: Vec<u8>| Section {
            tag: *tag,
            version: 1,
            frame,
            part: 7,
            data,
        };
        vec![
            section(b"META", 0, b"{}".to_vec()),
            section(b"ZZZZ", 1, vec![5; 1000]),
            section(b"TRAF", 2, (0..=255).collect()),
        ]
    }

    fn write(sections: &[Section]) -> Vec<u8> {
        let packed: Vec<_> = sections.iter().map(|s| s.pack(Codec::Zstd)).collect();
        assemble(packed.iter().map(Vec::as_slice))
    }

    fn unpack(file: &[u8]) -> Result<Vec<Section>, TraceError> {
        let contents = read(file)?;
        contents.entries.iter().map(|e| e.unpack(file)).collect()
    }

    #[test]
    fn what_was_written_is_read() {
        let file = write(&sections());
        assert_eq!(unpack(&file).unwrap(), sections());
        assert!(read(&file).unwrap().lost.is_none());
        assert!(file.len() < 900, "a thousand equal bytes are packed");
    }

    #[test]
    fn every_cut_leaves_what_lies_before_it() {
        let file = write(&sections());
        for cut in 0..file.len() {
            let part = &file[..cut];
            match unpack(part) {
                Ok(found) => {
                    assert!(found.len() <= 3);
                    assert_eq!(found, sections()[..found.len()], "cut at {cut}");
                    assert!(read(part).unwrap().lost.is_some(), "cut at {cut}");
                }
                Err(error) => assert!(cut < START, "cut at {cut}: {error}"),
            }
        }
    }

    /// A flipped bit is an error that says where; of the start, what kind of file it is.
    #[test]
    fn every_flipped_bit_is_noticed() {
        let file = write(&sections());
        let starts: Vec<u64> = read(&file)
            .unwrap()
            .entries
            .iter()
            .map(|e| e.offset)
            .collect();
        for at in 0..file.len() {
            for bit in 0..8 {
                let mut bad = file.clone();
                bad[at] ^= 1 << bit;
                match unpack(&bad) {
                    Ok(_) => assert!(at == 10 || at == 11, "byte {at} bit {bit}"),
                    Err(TraceError::Section { offset, .. }) => {
                        let own = starts.iter().rev().find(|s| **s <= at as u64);
                        assert!(offset >= *own.unwrap() && offset <= at as u64, "byte {at}");
                    }
                    Err(error) => assert!(at < START, "byte {at} bit {bit}: {error}"),
                }
            }
        }
    }

    #[test]
    fn sizes_that_lie_are_refused_before_memory_is_asked_for() {
        let file = write(&sections());
        let second = read(&file).unwrap().entries[1].offset as usize;
        for raw in [u64::MAX, 1 << 40, 1 << 33, 1 << 30] {
            let mut bad = file.clone();
            bad[second + 16..second + 24].copy_from_slice(&raw.to_le_bytes());
            let entry = Entry::at(&bad, second).unwrap();
            assert!(entry.unpack(&bad).is_err(), "{raw}");
        }
        let mut long = file.clone();
        long[second + 24..second + 32].copy_from_slice(&u64::MAX.to_le_bytes());
        assert!(Entry::at(&long, second).is_none());
        assert!(read(&long).is_err());
    }

    #[test]
    fn a_section_has_the_size_that_its_header_says() {
        let file = write(&sections());
        let second = read(&file).unwrap().entries[1];
        assert_eq!((second.codec, second.raw), (1, 1000));
        for raw in [999, 1001] {
            let error = Entry { raw, ..second }.unpack(&file).unwrap_err();
            assert!(error.to_string().contains("another size"), "{error}");
        }
    }

    #[test]
    fn an_index_lists_what_is_there_and_no_more() {
        let file = write(&sections());
        let all = read(&file).unwrap().entries;
        let end = all[2].end().unwrap();
        let with_index = |entries: &[Entry], more: &[u8]| {
            let mut data = Vec::new();
            for e in entries {
                let at = e.offset as usize;
                data.extend(e.offset.to_le_bytes());
                data.extend(&file[at..at + HEADER]);
            }
            data.extend(more);
            let index = Section {
                tag: INDEX,
                version: 1,
                frame: 0,
                part: 0,
                data,
            };
            let index = index.pack(Codec::Raw);
            let footer = [(end as u64).to_le_bytes(), MAGIC].concat();
            read(&[&file[..end], &index[..], &footer[..]].concat())
        };
        assert!(with_index(&all, &[]).unwrap().lost.is_none());
        let wrong = [
            (&all[..2], vec![]),
            (&all[..], vec![0]),
            (&all[..], vec![0; 8 + HEADER]),
        ];
        for (entries, more) in wrong {
            let error = with_index(entries, &more).unwrap_err().to_string();
            assert!(error.contains("does not list"), "{error}");
        }
    }
}
