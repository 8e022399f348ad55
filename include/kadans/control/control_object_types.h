// The types of control objects that a program can make, by the name that a robot's configuration writes in "type".
//
// Types come from three sources:
//   1. Kadans itself; the app lists them.
//   2. A program that links Kadans; it registers them before main():
//        std::unique_ptr<ControlObject> make_spring(const ObjectSetup&);
//        KADANS_REGISTER_CONTROL_OBJECT("spring", make_spring)
//   3. Plug-ins (plugin_library.h).
// A name belongs to one type: a second type with the same name is refused.
//
// Before the loop, one thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/control/control_object.h"

namespace kadans {

// Throws std::invalid_argument, with a reason, when the setup does not suit.
using MakeControlObject = std::function<std::unique_ptr<ControlObject>(const ObjectSetup&)>;

class ControlObjectTypes {
 public:
  // `source` tells people where the type comes from. Throws std::invalid_argument on a name that is empty or taken.
  void add(const std::string& name, MakeControlObject make, const std::string& source = "kadans");
  // All that KADANS_REGISTER_CONTROL_OBJECT registered in this program.
  void add_registered();

  // nullptr for an unknown name.
  const MakeControlObject* find(std::string_view name) const noexcept;
  std::vector<std::string> names() const;  // in the order of adding

 private:
  struct Type {
    std::string name;
    MakeControlObject make;
    std::string source;
  };
  std::vector<Type> types_;
};

// An entry in the list of the types that were registered before main(). Only the macro makes one.
class RegisteredControlObject {
 public:
  using Make = std::unique_ptr<ControlObject> (*)(const ObjectSetup&);
  RegisteredControlObject(const char* name, Make make) noexcept;

 private:
  friend class ControlObjectTypes;
  const char* name_;
  Make make_;
  RegisteredControlObject* next_;
};

}  // namespace kadans

// Write it at namespace scope in a source file of the program itself: from a static library the linker drops source
// files that nothing else refers to.
#define KADANS_REGISTER_CONTROL_OBJECT(name, make) KADANS_REGISTER_CONTROL_OBJECT_AT(name, make, __COUNTER__)
#define KADANS_REGISTER_CONTROL_OBJECT_AT(name, make, count) KADANS_REGISTER_CONTROL_OBJECT_AS(name, make, count)
#define KADANS_REGISTER_CONTROL_OBJECT_AS(name, make, count)                                    \
  namespace {                                                                                   \
  const ::kadans::RegisteredControlObject kadans_registered_control_object_##count(name, make); \
  }                                                                                             \
  static_assert(true) /* takes the semicolon */
