#include "recorded_perception.h"

#include <algorithm>
#include <cmath>

#include "config/json/problems.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/nearest_name.h"
#include "telemetry/reading/record_observations.h"

namespace kadans {

RecordedPerception::RecordedPerception(const ScenarioPerception& settings, const std::vector<SeenInfo>& seen,
                                       const std::string& file) {
  const auto entry = std::ranges::find(seen, settings.entry.name, &SeenInfo::name);
  if (entry == seen.end()) refuse_unknown(file, settings.entry, "entry of the world model", names_of(seen));
  const std::int64_t from_ns = std::llround(1e9 * settings.from_s);
  bool told = false;
  for (const RecordedObservation& one : read_observations(settings.record.name)) {
    if (one.entry != entry->name) continue;
    told = true;
    if (one.came_ns < from_ns) continue;
    const std::int64_t at_ns = one.came_ns - from_ns;
    Observation observation{.entry = static_cast<std::uint32_t>(entry - seen.begin()),
                            .time_ns = at_ns - std::llround(1e9 * one.age_s),
                            .confidence = one.confidence,
                            .source = SeenSource::record};
    for (std::size_t i = 0; i < entry->fields.size(); ++i) {
      const auto field = std::ranges::find(one.fields, entry->fields[i].name, &std::pair<std::string, double>::first);
      if (field == one.fields.end())
        refuse(file, settings.record.place,
               settings.record.name + ": an observation of '" + entry->name + "' has no " + entry->fields[i].name +
                   ", which the entry has here");
      observation.fields.at(i) = field->second;
    }
    coming_.push_back({at_ns, observation});
  }
  if (!told)
    refuse(
        file, settings.record.place,
        settings.record.name + " tells nothing of '" + entry->name + "': kadans log observations lists what it does");
}

void RecordedPerception::look(std::int64_t time_ns, ObservationSink& sink) noexcept {
  for (; next_ < coming_.size() && coming_[next_].at_ns <= time_ns; ++next_) sink.observe(coming_[next_].observation);
}

}  // namespace kadans
