// The options of a control object by name, "options" in the configuration: what its type needs beyond joints and
// parameters. An object asks for its options when it is made. An option that it did not ask for is unknown to its type;
// the code that made the object refuses it.
//
// Before the loop, one thread.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace kadans {

class ObjectOptions {
 public:
  ObjectOptions() = default;
  ObjectOptions(std::map<std::string, std::string> texts) : texts_(std::move(texts)) {}  // NOLINT: written in braces

  // nullptr when it was not given.
  const std::string* find(const std::string& name) const {
    asked_.push_back(name);
    const auto found = texts_.find(name);
    return found == texts_.end() ? nullptr : &found->second;
  }
  const std::map<std::string, std::string>& given() const noexcept { return texts_; }
  // The names that find was asked for.
  const std::vector<std::string>& asked() const noexcept { return asked_; }

 private:
  std::map<std::string, std::string> texts_;
  mutable std::vector<std::string> asked_;
};

// An option is missing, or has a value that the type cannot use.
class OptionError : public std::invalid_argument {
 public:
  OptionError(std::string option, const std::string& message)
      : std::invalid_argument(message), option_(std::move(option)) {}
  const std::string& option() const noexcept { return option_; }

 private:
  std::string option_;
};

}  // namespace kadans
