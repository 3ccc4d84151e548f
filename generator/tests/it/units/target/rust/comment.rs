use bryant_generator::target::rust::comment::{marked, splice};
use quote::quote;

#[test]
fn comments_survive_formatting() {
    let comment = marked("belt \"lap\": tension");
    let tokens = quote!(fn f() { let a = 1; #comment let b = 2; });
    let file = syn::parse2(tokens).expect("a function");
    let text = splice(&prettyplease::unparse(&file));
    assert_eq!(
        text,
        "fn f() {\n    let a = 1;\n\n    // belt \"lap\": tension\n    let b = 2;\n}\n"
    );
}

#[test]
fn a_comment_cannot_leave_its_line() {
    let comment = marked("a\nfn evil() {}");
    let file = syn::parse2(quote!(fn f() { #comment let b = 2; })).expect("a function");
    let text = splice(&prettyplease::unparse(&file));
    assert_eq!(text, "fn f() {\n    // a fn evil() {}\n    let b = 2;\n}\n");
}
