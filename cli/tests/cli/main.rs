//! The program from outside: a module for each verb or promise, in one binary, which
//! is linked once.

mod against;
mod as_done;
mod attack;
mod bad_input;
mod bench;
mod cache;
mod common;
mod compare;
mod conventions;
mod draws;
mod environment;
mod export;
mod light_images;
mod looking_inside;
mod overlays;
mod pixel;
mod render;
mod report;
mod reproduce;
mod same_bits;
mod show;
mod stress;
mod sweep;
mod textures;
mod traces;
mod traffic;
mod tune;
mod verbs;
mod view;
mod walk_through;
mod wild;
