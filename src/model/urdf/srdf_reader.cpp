// Which links of a robot need not collide with each other, as MoveIt's setup assistant writes it down.
#include "kadans/model/urdf.h"
#include "signal/input_file.h"
#include "urdf_document.h"

namespace kadans {

std::vector<LinkPair> read_srdf(const std::string& file, const RobotModel& model, std::vector<InputProblem>* warnings) {
  const std::string text = read_input_file(file);
  UrdfDocument document(text, file);
  const UrdfElement root(document, document.root());
  if (root.shown_name() != "<robot>")
    document.stop(root.at(), "the root element is " + root.shown_name() + ", an SRDF's is <robot>");
  for (const char* of_urdf : {"link", "joint"}) {
    if (const auto* xml = document.root().FirstChildElement(of_urdf); xml != nullptr)
      document.stop(UrdfElement(document, *xml).at(),
                    "an SRDF has no <" + std::string(of_urdf) + "> in its <robot>: this is a URDF");
  }
  std::vector<LinkPair> pairs;
  for (const auto* xml = document.root().FirstChildElement("disable_collisions"); xml != nullptr;
       xml = xml->NextSiblingElement("disable_collisions")) {
    const UrdfElement e(document, *xml);
    LinkPair pair;
    std::string reason;
    if (!e.attributes({{"link1", UrdfValue::name, &pair.first, true},
                       {"link2", UrdfValue::name, &pair.second, true},
                       {"reason", UrdfValue::text, &reason}}))
      continue;
    bool known = true;
    for (const auto& [name, attribute] : {std::pair{&pair.first, "link1"}, std::pair{&pair.second, "link2"}}) {
      if (model.find_link(*name)) continue;
      known = false;
      document.warn(e.at_value(attribute), "the robot has no link " + shown_quoted(*name) + ": this pair is not used",
                    "pair of unknown link");
    }
    if (known) pairs.push_back(std::move(pair));
  }
  document.throw_if_refused();
  if (warnings != nullptr) *warnings = document.warnings();
  return pairs;
}

}  // namespace kadans
