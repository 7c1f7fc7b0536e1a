pub struct X { pub guid: &'static str }
pub const PLANT: X = X { guid: "" };
