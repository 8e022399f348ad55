// One element of a URDF while it is read: its attributes and its children are asked for once, by one list each, which
// says what may be there. Whatever else is there, or is missing or wrong, is refused. Elements and attributes with a
// name space (drake:..., xml:...) are left alone everywhere, elements of others (gazebo, transmission, ...) in <robot>
// unless their name is nearly one of URDF's.
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
