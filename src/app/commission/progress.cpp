#include "progress.h"

#include <filesystem>

#include "config/json/json_value.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

const std::string nothing_found;

}  // namespace

Progress::Progress(const std::string& robot, std::string plant, bool anew)
    : file_(robot + ".commission"), plant_(std::move(plant)) {
  if (anew || !std::filesystem::exists(file_)) return;
  const JsonValue json = parse_json(read_input_file(file_), file_);
  const JsonMember* const of = json.find("plant");
  if (of == nullptr || of->value.text != plant_)
    refuse(file_, "is of another plant than '" + plant_ + "'; --again begins anew");
  for (const JsonMember& step : json.members) {
    for (const JsonMember& joint : step.value.members) steps_[step.name][joint.name] = joint.value.text;
  }
}

bool Progress::done(std::string_view step, const std::string& joint) const {
  const auto found = steps_.find(std::string(step));
  return found != steps_.end() && found->second.contains(joint);
}

const std::string& Progress::found(std::string_view step, const std::string& joint) const {
  const auto found = steps_.find(std::string(step));
  if (found == steps_.end()) return nothing_found;
  const auto at = found->second.find(joint);
  return at == found->second.end() ? nothing_found : at->second;
}

// What is kept are names and words, which need no escapes.
void Progress::set(std::string_view step, const std::string& joint, const std::string& found) {
  steps_[std::string(step)][joint] = found;
  std::string text = "{\n  \"plant\": \"" + plant_ + "\"";
  for (const auto& [name, joints] : steps_) {
    text += ",\n  \"" + name + "\": {";
    bool first = true;
    for (const auto& [key, value] : joints) {
      text += (first ? " \"" : ", \"") + key + "\": \"" + value + "\"";
      first = false;
    }
    text += " }";
  }
  write_durably(file_, text + "\n}\n");
}

}  // namespace kadans
