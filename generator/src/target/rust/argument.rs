//! Arguments of methods as Rust.

use crate::method::inputs::Argument;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

impl Argument {
    /// The name and type of the argument. The name begins with an underscore if no code reads the argument.
    pub(crate) fn declaration(self, read: bool) -> TokenStream {
        let name = format_ident!("{}{}", if read { "" } else { "_" }, self.name());
        match self.array() {
            None => quote!(#name: T),
            Some(array) => quote!(#name: &#array),
        }
    }

    /// The type of a field that borrows the argument for `'a`.
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
