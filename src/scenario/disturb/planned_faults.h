// Makes the wrappers that inject a scenario's faults into the plant and into the behaviors' commands.
#pragma once

#include <cstdint>
#include <memory>

#include "config/scenario/scenario_config.h"
#include "engine/settings.h"
#include "faulty_host.h"
#include "faulty_plant.h"
#include "quantities.h"

namespace kadans {

// Wraps a robot of the world when the scenario has faults of sensors, drives or supply, or a delay of the actuation;
// else returns nullptr. Throws InputError for names that the robot does not have.
std::unique_ptr<FaultyPlant> make_faulty_plant(const ScenarioConfig& scenario, const PlantVariant& variant,
                                               const EngineSettings& engine, std::uint64_t seed, World& world,
                                               std::size_t robot = 0);

// Wraps the host of the behaviors when the scenario has faults of commands; else returns nullptr.
std::unique_ptr<FaultyHost> make_faulty_host(const ScenarioConfig& scenario, BehaviorHost& host);

}  // namespace kadans
