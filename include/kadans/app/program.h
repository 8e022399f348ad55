// The whole program as one function. Your own program may register control objects (control_object_types.h) and call
// this function. It is then `kadans` with those types: it simulates, checks and reports as the installed program does.
//
//   KADANS_REGISTER_CONTROL_OBJECT("spring", make_spring);
//   int main(int argc, char** argv) { return kadans::run_program(argc, argv); }
#pragma once

namespace kadans {

// Returns the exit code: 0 passed, 1 failed, 2 wrong usage or input, 3 internal error, 130 interrupted. Throws nothing.
int run_program(int argc, char** argv);

}  // namespace kadans
