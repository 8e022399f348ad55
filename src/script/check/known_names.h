// The names that the functions of a behavior may use. They are read from the tables that the functions will get: `m`,
// `s`, the `kadans` module and the globals.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "script/behavior/behavior_parts.h"
#include "source_scopes.h"

namespace kadans {

struct KnownNames {
  // The fields of a table. A field that is no table has an empty shape.
  struct Shape {
    std::map<std::string, Shape> fields;
    bool open = false;  // may hold any field: vars, args
    std::vector<std::string> names() const;
  };
  Shape machine, snapshot, module, globals;  // machine: `m` of all machines together
  std::map<std::string, Shape> machines;     // `m` of the machines in each behavior's file
  std::vector<std::string> object_methods;
  std::map<std::string, std::vector<std::string>> parameters;  // by the file that declares them
  std::map<std::string, std::vector<std::string>> vars;        // by the file of the behavior
  std::map<std::string, Shape> modules;  // the author's, by their names in `require`; one that is no table is open
  // Fields that are assigned to tables of unknown owner; they may belong to any module.
  std::set<std::string> given_somewhere;
  std::map<std::string, SourceScopes::ChartLines> functions;  // of the chart, by file
};

// `parts` is a loaded behavior or a module. For a module `m` and `s` are open, because its users are unknown.
KnownNames read_known_names(Behavior::Parts& parts);

}  // namespace kadans
