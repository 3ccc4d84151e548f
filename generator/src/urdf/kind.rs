//! What a file is, by its content: messages for files that are no URDF.

use std::ops::Range;

/// A format with another root element than URDF.
struct Format {
    root: &'static str,
    /// What the file is.
    name: &'static str,
    help: &'static str,
}

const NO_URDF: &str = "only URDF and models in YAML can be read (yet): look for a description of the robot as URDF, or write the model in YAML, see docs/reference.md";

const FORMATS: &[Format] = &[
    Format {
        root: "mujoco",
        name: "MJCF, the format of MuJoCo",
        help: NO_URDF,
    },
    Format {
        root: "mujocoinclude",
        name: "a part of MJCF, the format of MuJoCo",
        help: NO_URDF,
    },
    Format {
        root: "sdf",
        name: "SDF, the format of Gazebo",
        help: NO_URDF,
    },
    Format {
        root: "gazebo",
        name: "SDF of an early version, the format of Gazebo",
        help: NO_URDF,
    },
    Format {
        root: "world",
        name: "a world of Gazebo",
        help: NO_URDF,
    },
    Format {
        root: "model",
        name: "a description of a model, such as `model.config` of Gazebo",
        help: NO_URDF,
    },
    Format {
        root: "COLLADA",
        name: "COLLADA, the shape of a body",
        help: "shapes are not read; give the URDF file of the robot",
    },
    Format {
        root: "launch",
        name: "a launch file of ROS",
        help: "give the URDF file that it loads",
    },
    Format {
        root: "package",
        name: "the manifest of a package of ROS",
        help: "give a URDF file of the package, often in its folder `urdf`",
    },
    Format {
        root: "OpenSimDocument",
        name: "a model of OpenSim",
        help: NO_URDF,
    },
    Format {
        root: "svg",
        name: "a picture (SVG)",
        help: "give a model in YAML or the URDF file of a robot",
    },
    Format {
        root: "html",
        name: "a page of the web (HTML), not the file that it shows",
        help: "download the file itself; GitHub gives it under `Raw`",
    },
];

/// Whether a text is XML by its beginning: behind blanks and a byte order mark a `<`, and no second one, which YAML may
/// have.
pub fn is_xml(text: &str) -> bool {
    let begins = text[before(text)..].strip_prefix('<');
    begins.is_some_and(|rest| rest.starts_with(|c: char| c.is_alphabetic() || "?!_".contains(c)))
}

/// The text of XML in UTF-16, which its first character tells, or in ISO 8859-1, which its declaration says; `None` for
/// anything else.
pub fn decoded(bytes: &[u8]) -> Option<String> {
    let words = |of: fn([u8; 2]) -> u16| {
        let words: Vec<u16> = bytes.chunks_exact(2).map(|b| of([b[0], b[1]])).collect();
        String::from_utf16(&words).ok()
    };
    let text = match bytes {
        [0xff, 0xfe, ..] => words(u16::from_le_bytes),
        [0xfe, 0xff, ..] => words(u16::from_be_bytes),
        _ => {
            let declaration = bytes.split(|b| *b == b'>').next().unwrap_or_default();
            let declaration = String::from_utf8_lossy(declaration).to_lowercase();
            let known = ["iso-8859-1", "latin1", "windows-1252", "us-ascii"];
            let latin =
                declaration.contains("<?xml") && known.iter().any(|k| declaration.contains(k));
            // each byte is the character of its number
            latin.then(|| bytes.iter().map(|b| char::from(*b)).collect())
        }
    };
    text.filter(|text| is_xml(text))
}

/// The length of what stands before the content: blanks, and the byte order mark.
pub fn before(text: &str) -> usize {
    let start = text.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
    text.len() - start.len()
}

/// What a file with this root element is instead of URDF, and what to do.
pub fn other_format(root: &str) -> Option<(&'static str, &'static str)> {
    let format = (FORMATS.iter()).find(|f| f.root.eq_ignore_ascii_case(root))?;
    Some((format.name, format.help))
}

/// The places of what stands before the content of the root element, in bytes.
pub struct Head {
    /// The name of the root element.
    pub root: Option<Range<usize>>,
    /// The declaration of a type of document.
    pub doctype: Option<Range<usize>>,
    /// The declaration `<?xml …?>`.
    pub declaration: Option<usize>,
}

/// Finds the root element, past comments and declarations.
pub fn head(text: &str) -> Head {
    let mut head = Head {
        root: None,
        doctype: None,
        declaration: None,
    };
    let mut at = 0;
    while let Some(open) = text[at..].find('<').map(|found| at + found) {
        let rest = &text[open..];
        let past = |end: &str| {
            rest.find(end)
                .map_or(text.len(), |found| open + found + end.len())
        };
        at = if rest.starts_with("<!--") {
            past("-->")
        } else if rest.starts_with("<?") {
            if rest.starts_with("<?xml ") {
                head.declaration.get_or_insert(open);
            }
            past("?>")
        } else if rest.starts_with("<!") {
            let end = past(if rest[..past(">") - open].contains('[') {
                "]>"
            } else {
                ">"
            });
            head.doctype.get_or_insert(open..end);
            end
        } else {
            let name = &rest[1..];
            let length = name
                .find(|c: char| c.is_whitespace() || matches!(c, '/' | '>'))
                .unwrap_or(name.len());
            head.root = (length > 0).then(|| open + 1..open + 1 + length);
            return head;
        };
    }
    head
}
