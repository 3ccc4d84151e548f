//! Arguments of methods as Rust.

use crate::method::inputs::Argument;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

impl Argument {
    /// Name and type; the name begins with an underscore where nothing reads it.
    pub(crate) fn declaration(self, read: bool) -> TokenStream {
        let name = format_ident!("{}{}", if read { "" } else { "_" }, self.name());
        match self.array() {
            None => quote!(#name: T),
            Some(array) => quote!(#name: &#array),
        }
    }

    /// Type of a field of a struct that borrows for `'a`.
    pub(crate) fn borrowed(self) -> TokenStream {
        match self.array() {
            None => quote!(T),
            Some(array) => quote!(&'a #array),
        }
    }

    fn array(self) -> Option<TokenStream> {
        match self {
            Argument::Time => None,
            Argument::Coordinates => Some(quote!([T; COORDINATES])),
            Argument::Velocities | Argument::Accelerations => Some(quote!([T; VELOCITIES])),
            Argument::Auxiliaries => Some(quote!([T; AUXILIARIES])),
            Argument::Memory => Some(quote!([T; MEMORY])),
            Argument::EventFunctions => Some(quote!([T; EVENT_FUNCTIONS])),
        }
    }
}
