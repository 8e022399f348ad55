#include <set>

#include "kadans/model/inertia.h"
#include "kadans/signal/nearest_name.h"
#include "mesh_path.h"
#include "urdf_checks.h"
#include "urdf_value.h"

namespace kadans {
namespace {

using tinyxml2::XMLElement;

void check_inertia(UrdfDocument& document, const UrdfLink& link) {
  const XMLElement* inertial = link.element->FirstChildElement("inertial");
  const XMLElement* inertia = inertial == nullptr ? nullptr : inertial->FirstChildElement("inertia");
  if (inertia == nullptr) return;
  Inertia body;
  struct Entry {
    const char* name;
    double* value;
  };
  for (const Entry& entry : {Entry{"ixx", &body.xx}, Entry{"iyy", &body.yy}, Entry{"izz", &body.zz},
                             Entry{"ixy", &body.xy}, Entry{"ixz", &body.xz}, Entry{"iyz", &body.yz}}) {
    const auto number = read_number(attribute_or_empty(*inertia, entry.name));
    if (!number) return;  // the grammar has said so
    *entry.value = *number;
  }
  if (const auto defect = inertia_defect(body)) {
    document.refuse(*inertia, "the inertia of link '" + shown(link.name) + "' " + *defect);
  }
}

void check_mesh(UrdfDocument& document, const XMLElement& mesh, const UrdfLink& link, bool collides,
                const UrdfOptions& options) {
  if (collides && !options.mesh_hulls) {
    document.refuse(mesh, "the collision of link '" + shown(link.name) +
                              "' is a mesh, which collides only as its convex hull and only when mesh hulls are asked "
                              "for: ask, or use <box>, <sphere> or <cylinder>");
  }
  const std::string file = attribute_or_empty(mesh, "filename");
  if (file.empty() || find_mesh(file, document.file())) return;
  std::string where;
  if (file.starts_with("package://")) where = ": no folder of this package holds it, from the URDF's folder up";
  if (file.find("://") == std::string::npos) where = ": its path starts from the URDF's folder";
  document.refuse_value(mesh, "filename", "mesh file '" + shown(file) + "' is not there" + where);
}

void check_geometry(UrdfDocument& document, const XMLElement& holder, const UrdfLink& link,
                    const UrdfOptions& options) {
  const XMLElement* geometry = holder.FirstChildElement("geometry");
  if (geometry == nullptr) return;
  int shapes = 0;
  for (const XMLElement* shape = geometry->FirstChildElement(); shape != nullptr; shape = shape->NextSiblingElement()) {
    if (++shapes == 2) document.refuse(*shape, "a second shape in one <geometry>");
  }
  if (shapes == 0)
    document.refuse(*geometry, "<geometry> is empty: <box>, <sphere>, <cylinder> or <mesh> was expected");
  const bool collides = std::string_view(holder.Name()) == "collision";
  if (const XMLElement* mesh = geometry->FirstChildElement("mesh"))
    check_mesh(document, *mesh, link, collides, options);
}

// urdfdom resolves a name to a material of the robot, or of a link before: so must we.
class Materials {
 public:
  explicit Materials(UrdfDocument& document) : document_(document) {
    const XMLElement& robot = document.robot();
    for (const XMLElement* m = robot.FirstChildElement("material"); m != nullptr;
         m = m->NextSiblingElement("material")) {
      if (!defines(*m)) document.refuse(*m, "material '" + name(*m) + "' has neither <color> nor <texture>");
      if (!names_.insert(attribute_or_empty(*m, "name")).second) {
        document.refuse_value(*m, "name", "material '" + name(*m) + "' is defined twice");
      }
    }
  }

  void use(const XMLElement& visual) {
    const XMLElement* material = visual.FirstChildElement("material");
    if (material == nullptr || material->Attribute("name") == nullptr) return;
    const std::string wanted = attribute_or_empty(*material, "name");
    if (defines(*material)) {
      names_.insert(wanted);
    } else if (!names_.contains(wanted)) {
      const std::vector<std::string> known(names_.begin(), names_.end());
      document_.refuse_value(*material, "name",
                             "material '" + shown(wanted) + "' is not defined" + did_you_mean(wanted, known));
    }
  }

 private:
  static std::string name(const XMLElement& material) { return shown(attribute_or_empty(material, "name")); }
  static bool defines(const XMLElement& material) {
    return material.FirstChildElement("color") != nullptr || material.FirstChildElement("texture") != nullptr;
  }

  UrdfDocument& document_;
  std::set<std::string> names_;
};

}  // namespace

void check_links(UrdfDocument& document, const UrdfOutline& outline, const UrdfOptions& options) {
  Materials materials(document);
  for (const UrdfLink& link : outline.links) {
    check_inertia(document, link);
    for (const XMLElement* e = link.element->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view name = e->Name();
      if (name == "visual" || name == "collision") check_geometry(document, *e, link, options);
      if (name == "visual") materials.use(*e);
    }
  }
}

}  // namespace kadans
