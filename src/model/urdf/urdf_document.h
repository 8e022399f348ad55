// A URDF text as XML: its elements with their places, their attributes and values, and a list of the mistakes.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <tinyxml2.h>

#include "kadans/signal/input_error.h"
#include "model/xml_scan.h"

namespace kadans {

// The values that URDF's attributes can have, read strictly: a number takes up the whole text, is finite, and has a
// decimal point, not a comma.
enum class UrdfValue : std::uint8_t {
  text,                 // anything
  name,                 // not empty, at most 128 characters, no blanks around it
  unbounded,            // a number of any size, infinite too
  number,               // finite, magnitude at most 1e9
  not_negative,         // >= 0
  vector,               // three numbers
  not_negative_vector,  // three numbers >= 0
  color,                // four numbers in 0..1
};

// What is wrong with the text as such a value ("is not a number, did you mean '2.5'?"). Nothing when it is right; then
// its numbers are in `numbers`, which has room for them or is null.
std::optional<std::string> read_value(UrdfValue kind, std::string_view text, double* numbers);

// What is wrong or odd in a text, told in few lines: all notes of one kind are one line, with their number and the
// first places.
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

// A URDF text as XML, with the place of every element and a list of the mistakes.
class UrdfDocument {
 public:
  // Throws InputError when this is not text, not XML or unreasonably large. Keeps views of the text.
  UrdfDocument(std::string_view text, std::string file);

  const tinyxml2::XMLElement& root() const { return *xml_.RootElement(); }
  const std::string& file() const noexcept { return file_; }
  static const XmlTag& tag(const tinyxml2::XMLElement& element);
  std::string in_line(std::size_t at) const { return "line " + std::to_string(source_.place(at).line); }

  // Notes a mistake at a byte of the text: what cannot be simulated as it was meant. The mistake that fills the list
  // throws. Of `kind`: UrdfNotes.
  void refuse(std::size_t at, std::string message, std::string_view kind = {});
  // Notes a mistake after which reading cannot go on, and throws.
  [[noreturn]] void stop(std::size_t at, std::string message);
  // Notes an oddity, and what was made of it.
  void warn(std::size_t at, std::string message, std::string_view kind = {});

  // While it lives, a mistake is only an oddity, because the part that it is in can be left out.
  class Lenient {
   public:
    Lenient(UrdfDocument& document, std::string consequence);  // "this visual is left out"
    ~Lenient();
    Lenient(const Lenient&) = delete;
    Lenient& operator=(const Lenient&) = delete;
    bool clean() const noexcept { return document_.softened_ == 0; }  // there was no mistake

   private:
    UrdfDocument& document_;
    std::string consequence_before_;
    std::size_t softened_before_;
  };

  // InputError with all that is refused, sorted by place. When `strict`, warnings are mistakes.
  void throw_if_refused(bool strict = false);
  std::vector<InputProblem> warnings() const { return warnings_.told(file_, source_); }

 private:
  void link_tags();
  [[noreturn]] void throw_refused(bool strict = false);
  InputProblem problem(std::size_t at, std::string message) const;

  std::string file_;
  SourceText source_;
  XmlScan scan_;
  tinyxml2::XMLDocument xml_;
  UrdfNotes refused_, warnings_;
  std::string consequence_;   // of a mistake; "": it is refused
  std::size_t softened_ = 0;  // mistakes noted as oddities
};

// One element of a URDF while it is read. The reader asks once for its attributes and once for its children, each with
// a list of those that may be there. What is needed and missing, and what is wrong, is refused.
//
// Elements and attributes that are not URDF's (gazebo, contact, drake:..., dont_collapse) are told and not used. When
// their name is almost one of URDF's, and that one is missing, they are refused: a mistyped <axes> would be another
// robot.
class UrdfElement;

struct UrdfAttribute {
  const char* name;
  UrdfValue kind;
  std::variant<std::nullptr_t, std::string*, double*> to = nullptr;  // a text is put there also when it is wrong
  bool required = false;
};

enum class UrdfCount : std::uint8_t { at_most_one, one, any };

struct UrdfChild {
  const char* name;
  UrdfCount count;
  std::function<void(const UrdfElement&)> read;  // of a second one where one may be, the first counts
};

class UrdfElement {
 public:
  UrdfElement(UrdfDocument& document, const tinyxml2::XMLElement& element) : document_(document), element_(element) {}

  std::string shown_name() const { return "<" + shown(element_.Name()) + ">"; }
  std::size_t at() const { return UrdfDocument::tag(element_).at; }
  std::size_t at_name(std::string_view attribute) const;   // at() when there is no such attribute
  std::size_t at_value(std::string_view attribute) const;  // the same
  bool has(const char* attribute) const { return element_.Attribute(attribute) != nullptr; }
  std::string text(const char* attribute, const char* otherwise) const;  // for messages
  const tinyxml2::XMLElement& xml() const noexcept { return element_; }

  // True when all of these are right, and the required ones there.
  bool attributes(const std::vector<UrdfAttribute>& known) const;
  void children(const std::vector<UrdfChild>& known) const;
  // An element without children.
  bool leaf(const std::vector<UrdfAttribute>& known) const;

 private:
  void unknown_attribute(const char* name, const std::vector<std::string>& known,
                         std::set<std::string, std::less<>>& meant) const;
  void unknown_child(const UrdfElement& child, const std::vector<UrdfChild>& known,
                     std::set<std::string, std::less<>>& meant) const;

  UrdfDocument& document_;
  const tinyxml2::XMLElement& element_;
};

}  // namespace kadans
