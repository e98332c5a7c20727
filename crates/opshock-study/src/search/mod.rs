//! Search for the critical amplitude: ask and tell, no physics, no files.
