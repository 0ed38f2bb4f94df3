//! Traces from outside: old files, files that were tampered with, and files of any bytes.

mod any_bytes;
mod forge;
mod golden;
mod tampering;
mod trimming;
mod user_frame;
