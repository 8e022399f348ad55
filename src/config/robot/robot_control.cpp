// The parts of a robot's configuration that are about control: objects, sets, poses, parameters and presets.
#include <algorithm>
#include <map>
#include <stdexcept>

#include "kadans/control/set_partition.h"
#include "kadans/signal/nearest_name.h"
#include "robot_config.h"
#include "robot_reader.h"

namespace kadans {
namespace {

bool contains(const std::vector<PlacedName>& names, const std::string& name) {
  return std::any_of(names.begin(), names.end(), [&](const PlacedName& one) { return one.name == name; });
}

class ParameterValues {
 public:
  ParameterValues(const ObjectConfig& config, const ObjectInfo& object, const ParameterTable& table, Problems& problems)
      : ids_(object.parameters), table_(table), problems_(problems), object_(config.name) {
    for (const ParameterId id : ids_) names_.push_back(table.info(id).name.substr(config.name.size() + 1));
  }

  // The values that `entries` give, in the order of the parameters, later entries before earlier ones.
  std::vector<std::pair<ParameterId, double>> chosen(const std::vector<NumberEntry>& entries) {
    std::map<ParameterId, double> values;
    for (const NumberEntry& entry : entries) {
      const std::vector<std::size_t> fitting = matching(entry.key, names_);
      if (fitting.empty()) {
        problems_.add_unknown(entry.place, "parameter", entry.key, alike(entry.key),
                              "of control object '" + object_ + "'");
      }
      for (const std::size_t i : fitting) {
        if (in_range(entry, table_.info(ids_[i]))) values[ids_[i]] = entry.value;
      }
    }
    return {values.begin(), values.end()};
  }

 private:
  // What may have been meant: for "*_knee.kp" the quantities of the joints that "*_knee" fits, else all parameters.
  std::vector<std::string> alike(const std::string& pattern) const {
    const std::size_t dot = pattern.rfind('.');
    if (dot == std::string::npos) return names_;
    std::vector<std::string> candidates;
    for (const std::string& name : names_) {
      const std::size_t name_dot = name.rfind('.');
      if (name_dot == std::string::npos || !matches(pattern.substr(0, dot), name.substr(0, name_dot))) continue;
      std::string candidate = pattern.substr(0, dot) + name.substr(name_dot);
      if (std::find(candidates.begin(), candidates.end(), candidate) == candidates.end()) {
        candidates.push_back(std::move(candidate));
      }
    }
    return candidates.empty() ? names_ : candidates;
  }

  bool in_range(const NumberEntry& entry, const Parameter& parameter) {
    if (entry.value >= parameter.min && entry.value <= parameter.max) return true;
    problems_.add(entry.value_place, parameter.name + " is " + number_text(entry.value) + ", must be " +
                                         number_text(parameter.min) + ".." + number_text(parameter.max) +
                                         (parameter.unit.empty() ? "" : " " + parameter.unit) + ": " + parameter.doc);
    return false;
  }

  const std::vector<ParameterId>& ids_;
  const ParameterTable& table_;
  Problems& problems_;
  std::string object_;
  std::vector<std::string> names_;  // without the object's
};

}  // namespace

void RobotReader::control(Fields& f) {
  f.list(
      "objects", {1, max_objects}, "the control objects", [&](Fields& e) { object(e); }, Need::required);
  f.map(
      "sets", "control sets: the control objects that are active together", [&](Fields& e) { control_set(e); },
      Need::required);
  drive_objects(f);
  f.number("switch_step_max", config_.switching.step_max, {1e-3, 1},
           "largest change of a drive's torque from tick to tick by a switch of sets, as a share of the joint's limit");
  f.number("switch_fade_s", config_.switching.fade_s, {1e-3, 10, "s"},
           "time in which the rest of the old set's torque fades; longer where switch_step_max demands it");
  unheld(f);
  initial_sets(f);
}

void RobotReader::drive_objects(Fields& f) {
  std::vector<PlacedName> given;
  f.strings("at_drives", given, {1, max_objects},
            "actuator-level control objects: they make the drives do what the sets demand of the joints; they are in "
            "no set and always active");
  const std::vector<std::string> names = names_of(config_.objects);
  for (const PlacedName& object : given) {
    const auto found = problems_.known(object, "control object", names);
    if (!found) continue;
    const auto index = static_cast<std::uint32_t>(*found);
    for (const ControlSetInfo& set : config_.sets) {
      if (std::find(set.objects.begin(), set.objects.end(), index) == set.objects.end()) continue;
      problems_.add(object.place, "control object " + in_quotes(object.name) + " is in control set " +
                                      in_quotes(set.name) + ": it cannot stand at the drives, too");
    }
    config_.at_drives.push_back(index);
  }
}

void RobotReader::unheld(Fields& f) {
  for (const Joint& joint : config_.model.joints) {
    config_.unheld.push_back({0, joint.passive() ? 0 : config_.safety.damping_Nms_per_rad});
  }
  f.map("unheld", "law of joints that no active control set holds, by joint pattern (default: they damp as in safety)",
        [&](Fields& entry) {
          each_joint(entry, config_.unheld, [&](UnheldLaw& law) {
            entry.number("stiffness_Nm_per_rad", law.stiffness_Nm_per_rad, {0, 1e4, "Nm/rad"},
                         "stiffness towards the position at which the joint was let go; 0: it only damps");
            entry.number("damping_Nms_per_rad", law.damping_Nms_per_rad, {0, 100, "Nms/rad"}, "damping of the joint");
          });
        });
  for (std::size_t i = 0; i < config_.unheld.size(); ++i) {
    if (config_.model.joints[i].passive()) config_.unheld[i] = {};
  }
}

void RobotReader::initial_sets(Fields& f) {
  std::string one;
  std::vector<PlacedName> several;
  const bool given =
      f.string("initial_set", one, "the control set that is active at the start (default: the first one)");
  if (given) several.push_back({one, f.place("initial_set")});
  f.strings("initial_sets", several, {1, max_control_sets},
            "instead of initial_set, several control sets that share no joint");
  const std::vector<std::string> names = names_of(config_.sets);
  if (f.reading() && names.size() > max_control_sets) {
    f.refuse("sets", ": at most " + std::to_string(max_control_sets) + " control sets");
    return;
  }
  SetMask initial = 0;
  for (const PlacedName& name : several) {
    if (const auto found = problems_.known(name, "control set", names))
      initial |= set_bit(static_cast<std::uint32_t>(*found));
  }
  if (initial != 0) config_.initial_sets = initial;
  Catalog layout;
  layout.sets = config_.sets;
  for (const ObjectConfig& object : config_.objects) layout.objects.push_back({.joints = object.joints});
  if (SetPartition(layout).clash(initial, initial)) {
    problems_.add(several.back().place, "control sets that are active first share a joint");
  }
}

void RobotReader::object(Fields& f) {
  constexpr NumberRange any_number{-1e9, 1e9};
  ObjectConfig object;
  std::vector<PlacedName> patterns;
  object.place = f.place();
  f.string("name", object.name, "name of the object for behaviors, parameters and signals", Need::required);
  f.string("type", object.type.name, "type of control object", Need::required);
  f.strings("joints", patterns, {1, max_joints}, "patterns of the motor joints that it drives", Need::required);
  f.integer("divisor", object.divisor, {1, 1000}, "the low level is computed every n-th control tick");
  f.integer("high_level_divisor", object.high_level_divisor, {1, 1000},
            "the high level is computed every n-th behavior tick");
  f.number("switch_dwell_s", object.switch_dwell_s, {0, switch_dwell_max_s, "s"},
           "least time between two switches of it, in or out of the active sets; an earlier one is refused");
  f.object("options", "options of the type, in addition to parameters",
           [&](Fields& e) { e.text_entries(object.options, "value of the option"); });
  f.object("parameters", "first values by parameter pattern",
           [&](Fields& e) { e.number_entries(object.parameters, any_number, "value in the parameter's unit"); });
  f.map("presets", "named values that a behavior may choose", [&](Fields& e) {
    PresetConfig& preset = object.presets.emplace_back();
    preset.name = {e.key(), e.key_place()};
    e.number_entries(preset.values, any_number, "value in the parameter's unit");
  });
  if (!f.reading()) return;
  object.type.place = f.place("type");
  if (!object.type.name.empty() && !object_types_.empty())
    (void)problems_.known(object.type, "type of control object", object_types_);
  if (!object.name.empty() && object.name.find_first_of(".* ") != std::string::npos) {
    f.refuse("name", ": " + in_quotes(object.name) + " must not contain '.', '*' or a space");
  }
  if (std::ranges::count(config_.objects, object.name, &ObjectConfig::name) > 0) {
    f.refuse("name", ": another control object is named " + in_quotes(object.name));
  }
  object_joints(patterns, object);
  config_.objects.push_back(std::move(object));
}

void RobotReader::object_joints(const std::vector<PlacedName>& patterns, ObjectConfig& object) {
  if (!have_model_) return;
  for (const PlacedName& pattern : patterns) {
    bool motor = false;
    const std::vector<std::size_t> chosen = joints(pattern.name, pattern.place);
    for (const std::size_t i : chosen) {
      if (config_.model.joints[i].passive()) continue;
      motor = true;
      object.joints.push_back(i);
    }
    if (!chosen.empty() && !motor) {
      problems_.add(pattern.place, "joint " + in_quotes(pattern.name) + " has no motor (effort 0 in the URDF)");
    }
  }
  std::sort(object.joints.begin(), object.joints.end());
  object.joints.erase(std::unique(object.joints.begin(), object.joints.end()), object.joints.end());
}

void RobotReader::control_set(Fields& entry) {
  std::vector<PlacedName> objects;
  entry.strings("objects", objects, {1, max_objects},
                "names of its control objects, in the order in which they are computed", Need::required);
  std::vector<PlacedName> sum, blend, priority;
  entry.strings("sum", sum, {1, max_objects}, "objects whose actuation is added to that of the objects before them");
  entry.strings("blend", blend, {1, max_objects},
                "objects whose actuation is mixed with it, by the parameter SET.OBJECT.weight");
  entry.strings("priority", priority, {1, max_objects}, "objects that replace it while they claim the joint");
  for (const auto* composed : {&sum, &blend, &priority}) {
    for (const PlacedName& object : *composed)
      (void)problems_.known(object, "control object", names_of(objects), "of this set");
  }
  ControlSetInfo set;
  set.name = entry.key();
  entry.number("switch_dwell_s", set.switch_dwell_s, {0, switch_dwell_max_s, "s"},
               "least time between two switches of it, in or out; an earlier one is refused");
  std::vector<std::size_t> owner(joint_names_.size(),
                                 config_.objects.size());  // the object of this set that sets a joint
  for (const PlacedName& object : objects) {
    const Composition composition = contains(sum, object.name)        ? Composition::sum
                                    : contains(blend, object.name)    ? Composition::blend
                                    : contains(priority, object.name) ? Composition::priority
                                                                      : Composition::set;
    if (!add_to_set(object, composition, set)) continue;
    claim_joints(set.objects.back(), composition == Composition::set, object.place, owner);
  }
  config_.sets.push_back(std::move(set));
}

bool RobotReader::add_to_set(const PlacedName& object, Composition composition, ControlSetInfo& set) {
  const auto found = problems_.known(object, "control object", names_of(config_.objects));
  if (!found) return false;
  const auto index = static_cast<std::uint32_t>(*found);
  if (std::find(set.objects.begin(), set.objects.end(), index) != set.objects.end()) {
    problems_.add(object.place, "control object " + in_quotes(object.name) + " stands twice in this set");
    return false;
  }
  set.objects.push_back(index);
  set.compositions.push_back(composition);
  return true;
}

void RobotReader::claim_joints(std::size_t object, bool sets, TextPlace place, std::vector<std::size_t>& owner) {
  for (const std::size_t joint : config_.objects[object].joints) {
    if (sets && owner[joint] < config_.objects.size()) {
      problems_.add(place, "control objects '" + config_.objects[owner[joint]].name + "' and '" +
                               config_.objects[object].name + "' of one set both drive joint '" + joint_names_[joint] +
                               "'");
      return;
    }
    owner[joint] = object;
  }
}

void RobotReader::pose(Fields& entry) {
  std::vector<NumberEntry> values;
  entry.number_entries(values, {-1e3, 1e3, "rad"}, "joint position by joint pattern");
  if (!have_model_) return;
  PoseInfo& pose = config_.poses.emplace_back();
  pose.name = entry.key();
  for (const NumberEntry& value : values) pose_value(entry, value, pose);
  std::sort(pose.position_rad.begin(), pose.position_rad.end());
}

void RobotReader::pose_value(const Fields& entry, const NumberEntry& value, PoseInfo& pose) {
  for (const std::size_t i : joints(value.key, value.place)) {
    const Joint& joint = config_.model.joints[i];
    if (!(value.value >= joint.lower_rad && value.value <= joint.upper_rad)) {
      return problems_.add(value.value_place, entry.path(value.key) + " is " + number_text(value.value) + ", joint '" +
                                                  joint.name + "' reaches " + number_text(joint.lower_rad) + ".." +
                                                  number_text(joint.upper_rad) + " rad");
    }
    std::erase_if(pose.position_rad, [&](const auto& given) { return given.first == i; });
    pose.position_rad.emplace_back(i, value.value);
  }
}

void apply_parameters(const RobotConfig& config, Catalog& catalog) {
  if (catalog.objects.size() != config.objects.size()) {
    throw std::invalid_argument("the catalog's control objects are not those of the configuration");
  }
  Problems problems(config.file);
  std::vector<std::pair<ParameterId, double>> all;
  for (std::size_t i = 0; i < config.objects.size(); ++i) {
    const ObjectConfig& object = config.objects[i];
    ParameterValues values(object, catalog.objects[i], catalog.parameters, problems);
    const auto own = values.chosen(object.parameters);
    all.insert(all.end(), own.begin(), own.end());
    catalog.objects[i].presets.clear();
    for (const PresetConfig& preset : object.presets) {
      catalog.objects[i].presets.push_back({preset.name.name, values.chosen(preset.values)});
    }
  }
  problems.throw_if_any();
  for (const auto& [id, value] : all) (void)catalog.parameters.set(id, value);  // chosen() looked at the range
}

}  // namespace kadans
