#include "disk_thread.h"

#include <chrono>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

namespace kadans {
namespace {

// The name of a new file is in its folder.
void sync_folder_of(const std::string& file) {
  const std::string folder = std::filesystem::path(file).parent_path().string();
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  (void)fsync(descriptor);
  close(descriptor);
}

}  // namespace

// Errors are the record's own: its next block is refused.
void DiskThread::Kept::sync(const std::string& newest) {
  if (descriptor >= 0) (void)fdatasync(descriptor);
  if (newest.empty() || newest == path) return;
  close();
  path = newest;
  descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  (void)fdatasync(descriptor);
  sync_folder_of(path);
}

void DiskThread::Kept::close() noexcept {
  if (descriptor < 0) return;
  (void)fdatasync(descriptor);
  ::close(descriptor);
  descriptor = -1;
}

void DiskThread::sync() {
  const RecordStatus status = records_.status_for_disk();
  record_.sync(status.file.data());
  flight_.sync(status.flight.data());
}

void DiskThread::work(const std::stop_token& stop) {
  constexpr std::chrono::seconds period{1};
  std::unique_lock lock(mutex_);
  while (!told_.wait_for(lock, stop, period, [] { return false; }) && !stop.stop_requested()) sync();
  sync();
  record_.close();
  flight_.close();
}

void DiskThread::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

}  // namespace kadans
