// The hot paths whose instructions are counted. Each is a fixed piece of work and the function in it that counts; what
// the work does beside it (building a robot, finding torques) does not.
#pragma once

#include <span>

namespace kadans::counts {

struct Path {
  const char* name;
  const char* function;  // as the linker knows it, demangled and whole
  int calls;             // of it in run()
  void (*run)(int calls);
};

std::span<const Path> paths();

}  // namespace kadans::counts
