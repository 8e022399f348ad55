#include "live_protocol.h"

#include "config/json/foreign_json.h"

namespace kadans {
namespace {

std::vector<std::byte> taken(const ByteWriter& writer) {
  const std::span<const std::byte> bytes = writer.bytes();
  return {bytes.begin(), bytes.end()};
}

Json command_in_json() {
  const Json request{
      {"title", "kadans.Command"},
      {"type", "object"},
      {"properties",
       {{"verb", {{"type", "string"}}}, {"text", {{"type", "string"}}}, {"value", {{"type", "number"}}}}}};
  const Json response{{"title", "kadans.Answer"},
                      {"type", "object"},
                      {"properties", {{"done", {{"type", "boolean"}}}, {"text", {{"type", "string"}}}}}};
  return {{"id", command_service},
          {"name", "/kadans/command"},
          {"type", "kadans.Command"},
          {"requestSchema", json_text(request)},
          {"responseSchema", json_text(response)},
          {"request",
           {{"encoding", "json"},
            {"schemaName", "kadans.Command"},
            {"schemaEncoding", "jsonschema"},
            {"schema", json_text(request)}}},
          {"response",
           {{"encoding", "json"},
            {"schemaName", "kadans.Answer"},
            {"schemaEncoding", "jsonschema"},
            {"schema", json_text(response)}}}};
}

}  // namespace

const std::string& service_advertisement() {
  static const std::string text =
      json_text({{"op", "advertiseServices"}, {"services", Json::array({command_in_json()})}});
  return text;
}

Json service_failure(std::uint32_t call, const std::string& why) {
  return {{"op", "serviceCallFailure"}, {"serviceId", command_service}, {"callId", call}, {"message", why}};
}

Json parameter_json(const LiveParameter& parameter) {
  return {{"name", parameter.name}, {"value", parameter.value}, {"type", "float64"}};
}

std::vector<std::byte> message_data(std::uint32_t subscription, std::uint64_t time_ns,
                                    std::span<const std::byte> payload) {
  ByteWriter to;
  to.put(std::uint8_t{1});
  to.put(subscription);
  to.put(time_ns);
  to.put(payload);
  return taken(to);
}

std::vector<std::byte> service_response(std::uint32_t call, const std::string& json) {
  ByteWriter to;
  to.put(std::uint8_t{3});
  to.put(command_service);
  to.put(call);
  to.put_string("json");
  to.put(bytes_of(json));
  return taken(to);
}

std::vector<std::byte> asset_response(std::uint32_t request, const std::string& uri, const std::string* content) {
  ByteWriter to;
  to.put(std::uint8_t{4});
  to.put(request);
  to.put(std::uint8_t{content ? std::uint8_t{0} : std::uint8_t{1}});
  to.put_string(content ? "" : "there is no asset " + uri);
  if (content) to.put(bytes_of(*content));
  return taken(to);
}

std::optional<ServiceCall> read_service_call(std::span<const std::byte> bytes) {
  ByteReader from(bytes);
  if (from.left() < 1 + 3 * sizeof(std::uint32_t)) return std::nullopt;
  (void)from.take<std::uint8_t>();
  ServiceCall call;
  call.service = from.take<std::uint32_t>();
  call.call = from.take<std::uint32_t>();
  const std::size_t encoding = from.take<std::uint32_t>();
  if (encoding > from.left()) return std::nullopt;
  const std::size_t head = bytes.size() - from.left() + encoding;
  call.request.assign(reinterpret_cast<const char*>(bytes.data()) + head, bytes.size() - head);
  return call;
}

}  // namespace kadans
