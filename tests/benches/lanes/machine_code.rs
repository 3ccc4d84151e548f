//! The length of the machine code of a function, read from the object files of a library.

use object::read::archive::ArchiveFile;
use object::{Object, ObjectSection, ObjectSymbol, SectionIndex, SymbolKind};

/// Bytes of the machine code of all functions of a Rust library whose symbols contain `word`; `None` if the format is
/// unknown or there is no such function.
pub fn size(library: &[u8], word: &str) -> Option<u64> {
    let archive = ArchiveFile::parse(library).ok()?;
    let mut total = None;
    for member in archive.members() {
        let Ok(data) = member.and_then(|member| member.data(library)) else {
            continue;
        };
        // the metadata of the library are not an object file
        if let Ok(file) = object::File::parse(data) {
            for size in of_object(&file, word) {
                *total.get_or_insert(0) += size;
            }
        }
    }
    total
}

/// Sizes of the functions of one object file.
fn of_object(file: &object::File<'_>, word: &str) -> Vec<u64> {
    let symbols = file.symbols().filter_map(|symbol| {
        let section: SectionIndex = symbol.section_index()?;
        let text = symbol.kind() == SymbolKind::Text;
        text.then(|| {
            (
                section,
                symbol.address(),
                symbol.size(),
                symbol.name().unwrap_or_default().to_owned(),
            )
        })
    });
    let mut symbols: Vec<_> = symbols.collect();
    symbols.sort_by_key(|(section, address, ..)| (section.0, *address));
    let size = |index: usize| {
        let (section, address, size, _) = &symbols[index];
        if *size > 0 {
            return *size;
        }
        // only some formats store sizes: in others a function ends where the next one begins
        let next = symbols[index + 1..]
            .iter()
            .find(|(s, a, ..)| s == section && a > address);
        let end = next.map(|(_, address, ..)| *address).or_else(|| {
            let section = file.section_by_index(*section).ok()?;
            Some(section.address() + section.size())
        });
        end.map_or(0, |end| end.saturating_sub(*address))
    };
    let wanted = (0..symbols.len()).filter(|&index| symbols[index].3.contains(word));
    wanted.map(size).collect()
}
