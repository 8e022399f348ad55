#include <cerrno>
#include <cmath>
#include <cstring>

#include <unistd.h>

#include "app/terminal.h"
#include "log_verbs.h"
#include "signal/durable_file.h"
#include "signal/number_text.h"
#include "signal/utf8.h"

namespace kadans {

namespace fs = std::filesystem;

namespace {

std::int64_t nanoseconds(const char* option, double time_s) {
  if (!(std::abs(time_s) <= 9e9)) refuse(option, "must be a time in seconds");
  return std::llround(time_s * 1e9);
}

}  // namespace

TimeSpan span_of(const LogOptions& options) {
  TimeSpan span;
  if (options.from_s) span.from_ns = nanoseconds("--from", *options.from_s);
  if (options.to_s) span.to_ns = nanoseconds("--to", *options.to_s);
  if (span.from_ns > span.to_ns) refuse("--to", printed("%g s is before --from %g s", *options.to_s, *options.from_s));
  return span;
}

void require_overlap(const RecordOutline& record, TimeSpan span) {
  if (span.from_ns <= record.last_ns && span.to_ns >= record.first_ns) return;
  refuse(record.file, printed("holds nothing between these times: it goes from %.3f s to %.3f s",
                              seconds(record.first_ns), seconds(record.last_ns)));
}

void tell_problem(const McapReader& reader) {
  if (!reader.complete() && !reader.problem().empty())
    print_error(reader.problem() + "; the record was cut short, this is what stands before");
}

void tell_problem(const RecordOutline& record) {
  if (!record.complete) print_error(record.problem + "; the record was cut short, this is what stands before");
}

std::string plural(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

void require_free(const LogOptions& options) {
  std::error_code ignored;
  if (fs::equivalent(options.out, options.file, ignored)) refuse(options.out, "is the record itself");
  if (fs::exists(options.out, ignored) && !options.force) refuse(options.out, "is there already; --force replaces it");
}

UnfinishedFile::UnfinishedFile(const fs::path& file) : file_(end_of_link(file)), unfinished_(file_) {
  if (is_device_or_pipe(file_)) {
    finished_ = true;
  } else {
    unfinished_ += "." + std::to_string(getpid()) + ".part";
  }
}

UnfinishedFile::~UnfinishedFile() {
  std::error_code ignored;
  if (!finished_) fs::remove(unfinished_, ignored);
}

void UnfinishedFile::finish() {
  if (finished_) return;
  std::error_code error;
  fs::rename(unfinished_, file_, error);
  if (error) refuse(file_, "cannot be written: " + error.message());
  finished_ = true;
}

LineOutput::LineOutput(const std::string& file) : stream_(stdout), name_(file.empty() ? "stdout" : file) {
  on_terminal_ = file.empty() && isatty(STDOUT_FILENO) == 1;
  if (file.empty()) return;
  unfinished_ = std::make_unique<UnfinishedFile>(file);
  stream_ = std::fopen(unfinished_->path().c_str(), "wb");
  if (stream_ == nullptr) refuse(file, "cannot be written: " + std::string(strerror(errno)));
}

LineOutput::~LineOutput() {
  if (unfinished_ && stream_ != nullptr) (void)std::fclose(stream_);
}

bool LineOutput::failed() const {
  if (errno == EPIPE && !unfinished_) {
    if (std::freopen("/dev/null", "w", stdout) != nullptr) return false;  // the rest of stdout's buffer is dropped
  }
  refuse(name_, "cannot be written: " + std::string(strerror(errno)));
}

bool LineOutput::put(std::string_view line) {
  const std::string shown = on_terminal_ ? shown_text(line) : std::string();  // a record's texts may come from anywhere
  if (on_terminal_) line = shown;
  const bool written = std::fwrite(line.data(), 1, line.size(), stream_) == line.size();
  return written && std::fputc('\n', stream_) != EOF ? true : failed();
}

void LineOutput::finish() {
  if (!unfinished_) {
    if (std::fflush(stream_) != 0) (void)failed();
    return;
  }
  const int closed = std::fclose(std::exchange(stream_, nullptr));
  if (closed != 0) (void)failed();
  unfinished_->finish();
}

}  // namespace kadans
