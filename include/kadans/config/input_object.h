// Reads a JSON file of one's own as strictly as Kadans reads its own: each field is asked for by name, with its type,
// its range and a sentence; a key that nobody asks for is refused with the nearest one; all mistakes are told at once,
// each with file, line and column.
//
//   read_input_object("config/matches/drill.json", [&](InputObject& f) {
//     f.number("half_s", rules.half_s, {1, 3600, "s"}, "length of a half");
//   });
//
// A reader that asks for the text `based_on` lets a file say only what is different from another one, which it names
// from the project root, as in Kadans' own files.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "kadans/signal/input_error.h"

namespace kadans {

class Fields;

class InputObject {
 public:
  struct Range {
    double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
    std::string_view unit{};
  };
  using Read = std::function<void(InputObject&)>;

  explicit InputObject(Fields& fields) noexcept : fields_(&fields) {}

  // What is not in the file keeps its value. True: it was there and right.
  bool number(std::string_view name, double& value, Range range, std::string_view doc, bool required = false);
  bool whole(std::string_view name, std::uint64_t& value, std::uint64_t min, std::uint64_t max, std::string_view doc,
             bool required = false);
  bool text(std::string_view name, std::string& value, std::string_view doc, bool required = false);
  bool choice(std::string_view name, std::size_t& value, std::span<const std::string> names, std::string_view doc,
              bool required = false);
  bool object(std::string_view name, std::string_view doc, const Read& read, bool required = false);
  // Each object in the array.
  bool list(std::string_view name, std::string_view doc, const Read& read, bool required = false);
  // The path of a file or folder of the project, as it is written. There being none is a mistake.
  bool path(std::string_view name, std::string& value, std::string_view doc, bool required = false);

  bool is_file(const std::string& path) const;  // of the project

  bool reading() const noexcept;  // false: the fields are described, for a schema; there is no file

  // A mistake at the value of this field.
  void refuse(std::string_view name, const std::string& message);
  // Where the value of this field stands, without a message: for a mistake that is found only later.
  InputProblem place(std::string_view name) const;

 private:
  Fields* fields_;
};

// Throws InputError. Where a file is based on another one, that one is read first, so that its mistakes have their own
// places.
void read_input_object(const std::filesystem::path& file, const InputObject::Read& read);
// The same of a text; `file` stands in messages, and its project is where paths begin.
void read_input_text(std::string_view text, const std::filesystem::path& file, const InputObject::Read& read);

}  // namespace kadans
