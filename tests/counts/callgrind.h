// Instructions of one function while a program runs under valgrind's callgrind: the same on every machine and in every
// mood of it, unlike time.
#pragma once

#include <optional>
#include <string>

namespace kadans::counts {

bool have_callgrind();

// Of `program --path NAME`, in `function` and what it calls, over all calls of it. Nothing when the program failed or
// never called it.
std::optional<double> count_instructions(const std::string& program, const std::string& path,
                                         const std::string& function);

}  // namespace kadans::counts
