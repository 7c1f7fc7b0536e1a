"""What `cargo xtask bench` measures, and the table it writes."""
