//! Which operation cuts what another one leaves.

use super::{Operation, Setup};

impl Setup {
    /// The operation that cuts, of the same shapes, what the tool of `operation` leaves; `None` where none does.
    pub fn rest_of(&self, operation: &Operation) -> Option<&Operation> {
        let diameter = self.tool_of(operation).diameter;
        self.operations
            .iter()
            .find(|o| o.line > operation.line && o.select == operation.select && o.kind.rest_of() == Some(diameter))
    }
}
