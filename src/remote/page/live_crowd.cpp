#include "live_crowd.h"

#include <algorithm>

namespace kadans {
namespace {

bool sooner_request(const LiveConnection& a, const LiveConnection& b) noexcept {
  return a.trusted() != b.trusted() ? b.trusted() : a.turn() < b.turn();
}

bool sooner_reader(const LiveConnection& a, const LiveConnection& b) noexcept {
  return a.local() != b.local() ? b.local() : a.turn() < b.turn();
}

}  // namespace

std::size_t LiveCrowd::count(Standing standing) const noexcept {
  return static_cast<std::size_t>(std::ranges::count_if(
      connections_, [standing](const auto& one) { return !one->closed() && one->standing() == standing; }));
}

LiveConnection* LiveCrowd::first(Standing standing,
                                 bool (*order)(const LiveConnection&, const LiveConnection&)) noexcept {
  LiveConnection* found = nullptr;
  for (const auto& one : connections_) {
    if (one->closed() || one->standing() != standing) continue;
    if (found == nullptr || order(*one, *found)) found = one.get();
  }
  return found;
}

void LiveCrowd::take(std::unique_ptr<LiveConnection> connection) {
  if (count(Standing::request) >= LiveServer::requests_max) (void)close_one();
  connections_.push_back(std::move(connection));
  connections_.back()->start();
}

bool LiveCrowd::close_one() noexcept {
  LiveConnection* const oldest = first(Standing::request, sooner_request);
  if (oldest != nullptr) oldest->close();
  return oldest != nullptr;
}

bool LiveCrowd::make_room(bool writes, bool local) noexcept {
  if (writes) return count(Standing::writer) < LiveServer::writers_max;
  if (count(Standing::reader) < LiveServer::readers_max) return true;
  if (local) first(Standing::reader, sooner_reader)->close();
  return local;
}

void LiveCrowd::beat() noexcept {
  for (const auto& connection : connections_) connection->beat();
  connections_.remove_if([](const auto& connection) { return connection->over(); });
}

std::uint32_t LiveCrowd::clients() const noexcept {
  return static_cast<std::uint32_t>(count(Standing::reader) + count(Standing::writer));
}

}  // namespace kadans
