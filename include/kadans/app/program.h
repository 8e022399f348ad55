// The whole program as one call. A program of your own that registers its control objects (control_object_types.h) and
// calls this is `kadans` with those types in it: it simulates, checks and reports as the installed one does.
//
//   KADANS_REGISTER_CONTROL_OBJECT("spring", make_spring);
//   int main(int argc, char** argv) { return kadans::run_program(argc, argv); }
#pragma once

namespace kadans {

// Returns the exit code: 0 passed, 1 failed, 2 wrong usage or input, 3 internal error, 130 interrupted. Throws nothing.
int run_program(int argc, char** argv);

}  // namespace kadans
