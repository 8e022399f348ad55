// Empty: the precompiled header of all test programs is made for this file. main.cpp cannot have it, because there
// doctest's declarations and its body must come from one inclusion.
