// The faults that a scenario plans, put around the parts that fail.
#pragma once

#include <cstdint>
#include <memory>

#include "kadans/config/scenario_config.h"
#include "kadans/engine/settings.h"
#include "kadans/scenario/faulty_host.h"
#include "kadans/scenario/faulty_plant.h"
#include "kadans/scenario/quantities.h"

namespace kadans {

// Around the plant: its sensors and drives that fail, and the delay of its actuation. Nothing when none does. Throws
// InputError for joints and feet that the robot does not have.
std::unique_ptr<FaultyPlant> make_faulty_plant(const ScenarioConfig& scenario, const PlantVariant& variant,
                                               const EngineSettings& engine, std::uint64_t seed, World& world);

// Around the behaviors, when commands fail on their way.
std::unique_ptr<FaultyHost> make_faulty_host(const ScenarioConfig& scenario, BehaviorHost& host);

}  // namespace kadans
