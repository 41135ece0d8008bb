//! Oscillators by harmonic balance and continuation, against closed forms and other routes.

mod branches;
mod families;
mod harmonic_balance;
mod oscillator;
mod shooting;
