// The lines of a Lua file at which a debugger can stop.
#pragma once

#include <string>
#include <vector>

namespace kadans {

struct CodeLines {
  struct Function {
    std::string name;  // as its line has it: "rise" of `function lib.rise(m)`, `local rise = function`; "" for none
    int first = 0, last = 0;
    int code = 0;  // the first line of its code
  };
  std::string error;       // of the compiler; "": the file is well
  std::vector<int> lines;  // rising
  std::vector<Function> functions;

  // The first of its lines from this one on; 0: there is none.
  int line_from(int line) const noexcept;
};

// Nothing of the text runs.
CodeLines code_lines(const std::string& text);

}  // namespace kadans
