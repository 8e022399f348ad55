// Parameters and presets of the configuration, held against the tables that the control objects declared.
#include <algorithm>
#include <map>
#include <stdexcept>

#include "config/json/name_pattern.h"
#include "robot_config.h"

namespace kadans {
namespace {

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
        check_range(entry, table_.info(ids_[i]));
        values[ids_[i]] = entry.value;
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

  void check_range(const NumberEntry& entry, const Parameter& parameter) {
    if (entry.value >= parameter.min && entry.value <= parameter.max) return;
    problems_.add(entry.value_place, parameter.name + " is " + number_text(entry.value) + ", must be " +
                                         number_text(parameter.min) + ".." + number_text(parameter.max) +
                                         (parameter.unit.empty() ? "" : " " + parameter.unit) + ": " + parameter.doc);
  }

  const std::vector<ParameterId>& ids_;
  const ParameterTable& table_;
  Problems& problems_;
  std::string object_;
  std::vector<std::string> names_;  // without the object's
};

}  // namespace

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
  for (const auto& [id, value] : all) {
    if (!catalog.parameters.set(id, value)) throw std::logic_error("a checked parameter was refused");
  }
}

}  // namespace kadans
