use bryant::files::{place, refusal_of_windows, replace};
use std::io;

#[test]
fn a_failure_leaves_the_old_file_and_no_other() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("deep/er/table.csv");
    replace(&path, |out| out.write_all(b"old")).unwrap();
    let failure = replace(&path, |out| {
        out.write_all(b"new")?;
        Err(io::Error::other("disk full"))
    });
    let message = failure.unwrap_err().to_string();
    assert!(message.contains("table.csv") && message.contains("disk full"));
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    let files = std::fs::read_dir(path.parent().unwrap()).unwrap().count();
    assert_eq!(files, 1);
}

#[test]
fn names_of_devices_are_no_names_of_files_on_windows() {
    let bad = "con con.csv CON.tar.gz aux nul.svg prn.h com1.csv LPT9 lpt0.x com¹.csv a:b.csv what?.csv a. b<c \u{7}";
    for name in bad.split(' ').chain(["a ", "con .csv"]) {
        assert!(refusal_of_windows(name).is_some(), "{name}");
    }
    for name in
        "child-seat.csv console.csv com.csv com10.svg lpt .hidden a.con nul-1.csv".split(' ')
    {
        assert_eq!(refusal_of_windows(name), None, "{name}");
    }
}

#[test]
fn a_directory_is_not_replaced() {
    let directory = tempfile::tempdir().unwrap();
    assert!(replace(directory.path(), |_| Ok(())).is_err());
}

#[cfg(unix)]
#[test]
fn a_link_stays_and_what_it_points_to_is_replaced() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    std::fs::create_dir(at("real")).unwrap();
    std::os::unix::fs::symlink("real/table.csv", at("there")).unwrap();
    std::os::unix::fs::symlink("there", at("link")).unwrap();
    for text in ["first", "second"] {
        replace(&at("link"), |out| out.write_all(text.as_bytes())).unwrap();
        assert_eq!(std::fs::read_to_string(at("real/table.csv")).unwrap(), text);
        assert!(std::fs::symlink_metadata(at("link")).unwrap().is_symlink());
    }
    std::os::unix::fs::symlink("round", at("round")).unwrap();
    let round = replace(&at("round"), |_| Ok(()));
    assert!(round.unwrap_err().to_string().contains("too many links"));
}

#[test]
fn a_place_is_one_however_it_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| place(&directory.path().join(name));
    std::fs::write(directory.path().join("there"), "").unwrap();
    for [one, other] in [
        ["there", "./there"],
        ["there", "new/../there"],
        ["a.csv", "./a.csv"],
        ["a.csv", "new/../a.csv"],
        ["new/a.csv", "new/./a.csv"],
        ["new/er/../a.csv", "new/a.csv"],
    ] {
        assert_eq!(at(one), at(other), "{one} {other}");
    }
    assert_ne!(at("a.csv"), at("new/a.csv"));
    #[cfg(unix)]
    for [link, target] in [["link", "there"], ["loose", "a.csv"]] {
        std::os::unix::fs::symlink(target, directory.path().join(link)).unwrap();
        assert_eq!(at(link), at(target), "{link}");
    }
}
