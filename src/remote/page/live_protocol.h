// The texts and frames of the Foxglove WebSocket protocol that a live server sends and reads.
// https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "live_hub.h"
#include "signal/byte_order.h"

namespace kadans {

using Json = nlohmann::ordered_json;

inline constexpr std::uint32_t command_service = 1;

struct ServiceCall {
  std::uint32_t service = 0, call = 0;
  std::string request;
};

const std::string& service_advertisement();  // the same for all clients
Json service_failure(std::uint32_t call, const std::string& why);
Json parameter_json(const LiveParameter& parameter);

std::vector<std::byte> message_data(std::uint32_t subscription, std::uint64_t time_ns,
                                    std::span<const std::byte> payload);
std::vector<std::byte> service_response(std::uint32_t call, const std::string& json);
std::vector<std::byte> asset_response(std::uint32_t request, const std::string& uri, const std::string* content);
std::optional<ServiceCall> read_service_call(std::span<const std::byte> bytes);

}  // namespace kadans
