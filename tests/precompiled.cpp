// Empty: the precompiled headers of the tests' programs are made for this file. main.cpp cannot have it, because there
// doctest's declarations and its body must come from one inclusion.
