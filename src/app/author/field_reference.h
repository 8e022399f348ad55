// The manual's pages of reference that are made from the tables of configurations and of control objects.
#pragma once

#include <filesystem>
#include <string>

namespace kadans {

// All fields of the JSON files: robots, scenarios, sweeps, tunings. As Markdown.
std::string field_reference();

// The types of control objects with their parameters, set-points and signals, as the robots of a project use them. As
// Markdown. Throws InputError.
std::string object_reference(const std::filesystem::path& root);

}  // namespace kadans
