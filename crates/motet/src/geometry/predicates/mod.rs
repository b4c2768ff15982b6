//! Exact signs: orientation and in-sphere, with symbolic perturbation.
