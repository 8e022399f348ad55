// One element of a URDF while it is read. The reader asks once for its attributes and once for its children, each with
// a list of those that may be there. Everything else, and whatever is missing or wrong, is refused.
//
// In <robot>, foreign elements (gazebo, transmission, ...) are ignored, unless their name is almost one of URDF's.
// Elements and attributes with a name space (drake:..., xml:...) are ignored everywhere.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "urdf_document.h"
#include "urdf_value.h"

namespace kadans {

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
  std::function<void(const UrdfElement&)> read;  // a second one where one may be is refused, not read
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

  // True when all of these are right, and the required ones there.
  bool attributes(const std::vector<UrdfAttribute>& known) const;
  // How many there are, without those of others.
  std::size_t children(const std::vector<UrdfChild>& known) const;
  // An element without children.
  bool leaf(const std::vector<UrdfAttribute>& known) const;

 private:
  UrdfDocument& document_;
  const tinyxml2::XMLElement& element_;
};

}  // namespace kadans
