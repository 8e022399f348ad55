// The names that the functions of a behavior may use, read from the tables that they will be given: what `m`, `s`, the
// `kadans` module and the globals hold.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "behavior_parts.h"

namespace kadans {

struct KnownNames {
  // A table by its fields; a field that is no table has an empty shape.
  struct Shape {
    std::map<std::string, Shape> fields;
    bool open = false;  // holds what an author puts there: vars, args
    std::vector<std::string> names() const;
  };
  Shape machine, snapshot, module, globals;  // m: of all machines together
  std::map<std::string, Shape> machines;     // m of those in a file of a behavior
  std::vector<std::string> object_methods, motion_fields;
  std::map<std::string, std::vector<std::string>> parameters;  // by the file that declares them
  std::map<std::string, std::vector<std::string>> vars;        // by the file of the behavior
  std::map<std::string, Shape> modules;  // the author's own, by the names in `require`; what is no table is open
  // Fields that are given to tables of which nobody knows whose they are: they may be any module's.
  std::set<std::string> given_somewhere;
  // The functions of the chart by their file and the line where they begin: the keys ("enter", "when" ...) of each.
  std::map<std::string, std::map<int, std::set<std::string>>> functions;
};

// Of a behavior that is loaded, or of a module: then `m` and `s` are open, for nobody knows who will play it.
KnownNames read_known_names(Behavior::Parts& parts);

}  // namespace kadans
