#include "kadans/model/urdf.h"

#include <fstream>
#include <sstream>

#include <tinyxml2.h>

#include "kadans/signal/input_error.h"
#include "urdf_dom.h"
#include "urdf_merge.h"

namespace kadans {

RobotModel read_urdf(const std::string& file, const UrdfOptions& options) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(InputProblem{file, 0, 0, "cannot be read"});
  std::ostringstream text;
  text << in.rdbuf();
  return read_urdf_text(text.str(), file, options);
}

RobotModel read_urdf_text(const std::string& text, const std::string& file, const UrdfOptions&) {
  tinyxml2::XMLDocument xml;
  if (xml.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || xml.RootElement() == nullptr) {
    throw InputError(InputProblem{file, xml.ErrorLineNum(), 0, "not well-formed XML"});
  }
  std::vector<std::string> order;
  for (auto* e = xml.RootElement()->FirstChildElement("joint"); e != nullptr; e = e->NextSiblingElement("joint")) {
    order.emplace_back(e->Attribute("name"));
  }
  const UrdfDom dom = parse_with_urdfdom(text);
  if (!dom.complaints.empty()) throw InputError(InputProblem{file, 0, 0, dom.complaints.front()});
  return merge_fixed_joints(*dom.model, order, file);
}

}  // namespace kadans
