//! One quality measure per file; each agrees with Verdict where Verdict has it.
