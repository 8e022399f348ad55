// Runs one function of the string library twice, in the sandbox and in a LuaJIT as it comes, and tells both results.
//
// A case is a text: "FUNCTION [NUMBER]", the pattern and the replacement, a line each, then the subject. FUNCTION is a
// letter of functions below; NUMBER is where the search begins, or how often gsub replaces.
#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace kadans::fuzz {

// find, plain find, match, gmatch, gsub with a text, a table, a function.
inline constexpr std::string_view functions = "fpmgstc";

class PatternComparison {
 public:
  PatternComparison();
  ~PatternComparison();
  PatternComparison(const PatternComparison&) = delete;
  PatternComparison& operator=(const PatternComparison&) = delete;

  // False: the sandbox stopped it, so nobody may know whether LuaJIT would end; nothing is compared then.
  bool run(std::string_view text);
  const std::string& sandbox() const noexcept;  // what run() came to: all results, or the error
  const std::string& lua() const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace kadans::fuzz
