// What the elements of an MJCF say, with the defaults of their classes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/model/robot_model.h"
#include "model/urdf/urdf_document.h"

namespace kadans {

struct MjcfValue {
  std::string text;
  std::size_t at = 0;
};

// The attributes that elements of one name have where they do not say otherwise; by class.
class MjcfDefaults {
 public:
  explicit MjcfDefaults(UrdfDocument& document) : document_(document) {}

  void read(const tinyxml2::XMLElement& element);  // a <default> that stands in no other one
  bool knows(const std::string& name) const { return classes_.contains(name); }
  const MjcfValue* find(const std::string& of_class, const std::string& element, const std::string& attribute) const;

 private:
  using Attributes = std::map<std::string, MjcfValue, std::less<>>;
  using Class = std::map<std::string, Attributes, std::less<>>;  // by element

  void read(const tinyxml2::XMLElement& element, const std::string& name);

  UrdfDocument& document_;
  std::map<std::string, Class, std::less<>> classes_;
};

// read(element) of each child of this name.
template <typename Read>
void each_child(const tinyxml2::XMLElement& parent, const char* name, const Read& read) {
  for (const auto* e = parent.FirstChildElement(name); e != nullptr; e = e->NextSiblingElement(name)) read(*e);
}
inline std::size_t tag_at(const tinyxml2::XMLElement& e) { return UrdfDocument::tag(e).at; }

inline Vec3 vec3(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }
Vec3 unit(const Vec3& v) noexcept;  // z for what has no direction
// The shortest turn that brings z to a direction.
Quat z_to(const Vec3& direction) noexcept;

struct MjcfAngles {  // how a file writes them
  bool degrees = true;
  std::string sequence = "xyz";  // of euler; capitals: about the axes of the frame around
};

// One element, with the class that holds for it.
class MjcfElement {
 public:
  // `inherited`: the class of the bodies around it, where it names none.
  MjcfElement(UrdfDocument& document, const MjcfDefaults& defaults, const tinyxml2::XMLElement& element,
              const std::string& inherited);

  std::size_t at() const { return UrdfDocument::tag(element_).at; }
  std::string_view name() const { return element_.Name(); }
  const tinyxml2::XMLElement& xml() const noexcept { return element_; }
  // The class of what stands inside of it.
  const std::string& class_name() const noexcept { return class_; }

  std::optional<MjcfValue> find(const char* attribute) const;
  bool has(const char* attribute) const { return find(attribute).has_value(); }
  std::string text(const char* attribute, const std::string& otherwise = {}) const;
  // Between least and most numbers, `otherwise` when there are none; what is wrong is refused.
  std::vector<double> numbers(const char* attribute, std::size_t least, std::size_t most,
                              const std::vector<double>& otherwise = {}) const;
  double number(const char* attribute, double otherwise) const;
  // "true", "false", or "auto", which is nothing.
  std::optional<bool> flag(const char* attribute, std::optional<bool> otherwise = std::nullopt) const;
  // Where it stands in the frame around it.
  Pose pose(const MjcfAngles& angles) const;

 private:
  Quat orientation(const MjcfAngles& angles) const;

  UrdfDocument& document_;
  const MjcfDefaults& defaults_;
  const tinyxml2::XMLElement& element_;
  std::string class_;
};

}  // namespace kadans
