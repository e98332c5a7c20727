//! Content identities: digests of studies and stages.
