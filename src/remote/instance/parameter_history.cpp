
#include "parameter_history.h"

#include <algorithm>

#include "campaign/sweep/parameter_edit.h"
#include "config/json/fields.h"
#include "config/json/json_value.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"

namespace kadans {

void ParameterHistory::note(const ParameterChange& change) {
  if (steps_.size() == steps_max) steps_.erase(steps_.begin());
  steps_.push_back(change);
  move_on(change);
}

void ParameterHistory::drop() {
  const ParameterChange step = steps_.back();
  steps_.pop_back();
  move_on({step.name, step.now, step.before, step.chunk});
}

void ParameterHistory::move_on(const ParameterChange& change) {
  for (auto* const known : {&unsaved_, &set_}) {
    ParameterChange& all = known->try_emplace(change.name, change).first->second;
    all.now = change.now;
    if (all.now == all.before) known->erase(change.name);
  }
}

void ParameterHistory::saved(const std::vector<ParameterChange>& changes) {
  for (const ParameterChange& change : changes) {
    const auto found = unsaved_.find(change.name);
    if (found == unsaved_.end()) continue;
    found->second.before = change.now;
    if (found->second.now == change.now) unsaved_.erase(found);
  }
}

namespace {

// The control object that a parameter belongs to, or nullptr.
const ObjectInfo* owner_of(const std::string& name, const Catalog& catalog) {
  const auto id = catalog.parameters.find(name);
  const auto owner = std::ranges::find_if(catalog.objects, [&](const ObjectInfo& object) {
    return id && std::ranges::find(object.parameters, *id) != object.parameters.end();
  });
  return owner == catalog.objects.end() ? nullptr : &*owner;
}

ParameterEdit edit_of(const ParameterChange& change, const Catalog& catalog, const std::string& preset = {}) {
  const ObjectInfo* const owner = owner_of(change.name, catalog);
  if (owner == nullptr)
    refuse(change.name +
           " belongs to no control object, so it has no place in the file; 'kadans ctl undo' takes the change back");
  const std::string pattern = change.name.substr(owner->name.size() + 1);
  return {.object = owner->name, .pattern = pattern, .matched = {pattern}, .value = change.now, .preset = preset};
}

// The presets of a parameter's object that set it, with their values.
std::vector<PresetOverride> presets_of(const std::string& name, const Catalog& catalog) {
  std::vector<PresetOverride> all;
  const auto id = catalog.parameters.find(name);
  const ObjectInfo* const owner = owner_of(name, catalog);
  if (owner == nullptr) return all;
  for (const Preset& preset : owner->presets) {
    for (const auto& [parameter, value] : preset.values) {
      if (parameter == *id) all.push_back({name, preset.name, value});
    }
  }
  return all;
}

}  // namespace

struct ConfigurationText::Edits {
  std::vector<ParameterEdit> parameters;
  std::vector<BehaviorEdit> behaviors;
};

ConfigurationText::ConfigurationText(std::filesystem::path file, std::string robot)
    : file_(std::move(file)), robot_(std::move(robot)) {
  if (!file_.empty()) text_ = read_input_file(file_);
}

// What `behaviors` of the file calls the behavior that declares it.
std::string ConfigurationText::behavior_of(const ParameterChange& change) const {
  const std::filesystem::path chunk = change.chunk;
  if (chunk.parent_path() != std::filesystem::path("behaviors") / robot_ || chunk.extension() != ".lua")
    refuse(change.name + " is declared in " + change.chunk + ", and a robot's file names behaviors of behaviors/" +
           robot_ + " alone: change it there, or 'kadans ctl undo'");
  return chunk.stem().string();
}

ConfigurationText::Edits ConfigurationText::edits_of(const std::vector<ParameterChange>& changes,
                                                     const Catalog& catalog, const PresetSave& also) const {
  Edits edits;
  for (const ParameterChange& change : changes) {
    if (change.chunk.empty()) {
      edits.parameters.push_back(edit_of(change, catalog));
    } else {
      const std::string own = change.name.substr(change.name.find('.') + 1);
      edits.behaviors.push_back({.behavior = behavior_of(change), .parameter = own, .value = change.now});
    }
  }
  if (also.preset.empty()) return edits;
  const std::size_t before = edits.parameters.size();
  for (const ParameterChange& change : also.values) {
    for (const PresetOverride& preset : presets_of(change.name, catalog)) {
      if (preset.preset == also.preset) edits.parameters.push_back(edit_of(change, catalog, also.preset));
    }
  }
  if (edits.parameters.size() == before)
    refuse("preset '" + also.preset + "' sets none of what was changed; nothing was saved");
  return edits;
}

std::vector<PresetOverride> ConfigurationText::save(const std::vector<ParameterChange>& changes, const Catalog& catalog,
                                                    const PresetSave& also) {
  const std::lock_guard lock(mutex_);
  const std::string name = file_.string();
  if (file_.empty()) refuse("this instance was not made from a configuration file");
  if (read_input_file(file_) != text_) refuse(name, "was changed since this instance read it; nothing was saved");
  const Edits edits = edits_of(changes, catalog, also);
  std::string text = edit_behaviors(edit_parameters(text_, name, edits.parameters), name, edits.behaviors);
  write_durably(std::filesystem::canonical(file_), text);  // not over a link to it
  text_ = std::move(text);
  if (!also.preset.empty()) {
    for (const ParameterChange& change : also.values) presets_[{also.preset, change.name}] = change.now;
  }
  std::vector<PresetOverride> overridden;
  for (const ParameterChange& change : also.preset.empty() ? changes : also.values) {
    for (PresetOverride& preset : presets_of(change.name, catalog)) {
      const auto saved = presets_.find({preset.preset, preset.name});
      if (saved != presets_.end()) preset.value = saved->second;
      if (preset.value != change.now) overridden.push_back(std::move(preset));
    }
  }
  return overridden;
}

std::string ConfigurationText::told(std::size_t saved, const std::vector<PresetOverride>& overridden) const {
  std::string text = std::to_string(saved) + " parameters stand in " + file_.filename().string();
  for (std::size_t i = 0; i < overridden.size(); ++i) {
    const bool same = i > 0 && overridden[i].name == overridden[i - 1].name;
    text += same ? ", " : i == 0 ? "; presets override " : "), ";
    text += (same ? "" : overridden[i].name + " (") + overridden[i].preset + " " + number_text(overridden[i].value);
  }
  return text + (overridden.empty() ? "" : ")");
}

}  // namespace kadans
