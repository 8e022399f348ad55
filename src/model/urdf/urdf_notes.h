// What is wrong or odd in a text, told in few lines: all notes of one kind are one line, with their number and the
// first places.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/input_error.h"
#include "model/xml_scan.h"

namespace kadans {

class UrdfNotes {
 public:
  // At most 25 kinds are told, more than anybody reads at once; further ones are counted.
  static constexpr std::size_t most_kinds = 25;

  // `kind` groups notes that differ in a name only; "": the message itself is the kind.
  void add(std::size_t at, std::string message, std::string_view kind);
  bool empty() const noexcept { return kinds_.empty(); }
  bool full() const noexcept { return kinds_.size() >= most_kinds; }
  // One problem a kind, sorted by place.
  std::vector<InputProblem> told(const std::string& file, const SourceText& source) const;

 private:
  struct Kind {
    std::string message;    // of the first place
    std::size_t first = 0;  // of the places
    std::vector<std::size_t> places;
  };
  std::map<std::string, Kind, std::less<>> kinds_;
  std::size_t left_out_ = 0;
};

void sort_by_place(std::vector<InputProblem>& problems);

}  // namespace kadans
