#include "service/http/http_response.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <httplib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <memory>
#include <string>
#include <utility>

#include "engine/store/disk/file_system.hpp"
#include "service/http/http_range.hpp"
#include "service/http/problem.hpp"

namespace sluice {
namespace {

constexpr std::size_t kWorthCompressing = 1024;  // bytes
constexpr std::size_t kFileChunk = 64 * 1024;    // bytes

/// A file that is being sent.
struct OpenFile {
  FileDescriptor descriptor;
  ByteRange part;
};

/// An answer in the form that is written: one of body, file or stream.
struct Ready {
  Response response;
  std::shared_ptr<OpenFile> file;
};

/// RFC 9110, 5.6.7: in English whatever the locale, and in UTC.
std::string http_date(std::time_t now) {
  constexpr std::array kDays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr std::array kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                               "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  return fmt::format("{}, {:02} {} {} {:02}:{:02}:{:02} GMT",
                     kDays[static_cast<std::size_t>(utc.tm_wday)], utc.tm_mday,
                     kMonths[static_cast<std::size_t>(utc.tm_mon)], utc.tm_year + 1900, utc.tm_hour,
                     utc.tm_min, utc.tm_sec);
}

bool names_tag(std::string_view header, std::string_view tag) {
  return header == "*" || header.find(tag) != header.npos;
}

void require_range(Ready& ready, const Request& request, std::uint64_t size, std::string_view tag) {
  const std::string_view condition = request.header("if-range");
  if (!condition.empty() && condition != tag) return;
  const auto asked = read_range(request.header("range"), size);
  if (const auto* part = std::get_if<ByteRange>(&asked)) {
    ready.file->part = *part;
    ready.response.status = 206;
    ready.response.headers.emplace_back(
        "Content-Range",
        fmt::format("bytes {}-{}/{}", part->first, part->first + part->count - 1, size));
  } else if (std::holds_alternative<NoSuchRange>(asked)) {
    ready.file.reset();
    ready.response = problem_response(
        ProblemType::range_not_satisfiable,
        fmt::format("the file has {} bytes, and one range at a time is sent", size));
    ready.response.headers.emplace_back("Content-Range", fmt::format("bytes */{}", size));
  }
}

Ready open_file(const Request& request, Response response) {
  Ready ready{std::move(response), nullptr};
  FileDescriptor file(::open(ready.response.file->c_str(),
                             O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY));
  struct stat status {};
  if (file.get() < 0 || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return {problem_response(ProblemType::no_such_file, "the file is not there any more"), nullptr};
  }
  const auto size = static_cast<std::uint64_t>(status.st_size);
  const std::string tag = fmt::format("\"{:x}-{:x}-{:x}.{:x}\"", status.st_ino, size,
                                      status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
  ready.response.headers.emplace_back("ETag", tag);
  ready.response.headers.emplace_back("Accept-Ranges", "bytes");
  ready.response.headers.emplace_back("Cache-Control", "no-cache");
  ready.file = std::make_shared<OpenFile>(OpenFile{std::move(file), {0, size}});
  if (names_tag(request.header("if-none-match"), tag)) {
    ready.response.status = 304;
    ready.response.content_type.clear();
    ready.file.reset();
  } else {
    require_range(ready, request, size, tag);
  }
  if (ready.file && ready.file->part.count == 0) ready.file.reset();
  return ready;
}

bool is_compressible(const Request& request, const Response& response) {
  if (response.body.size() < kWorthCompressing) return false;
  const std::string_view accept = request.header("accept-encoding");
  const std::size_t gzip = accept.find("gzip");
  return gzip != accept.npos && !accept.substr(gzip).starts_with("gzip;q=0");
}

/// What httplib reads in place of the client's request: all that its answer depends on.
std::string substitute_request(const Request& request, const Ready& ready, Afterwards afterwards) {
  std::string head = request.method == "HEAD" ? "HEAD / HTTP/1.1\r\n" : "GET / HTTP/1.1\r\n";
  if (is_compressible(request, ready.response)) head += "Accept-Encoding: gzip\r\n";
  if (afterwards == Afterwards::close) head += "Connection: close\r\n";
  return head + "\r\n";
}

/// Reads from a text, writes to a sink.
class SinkStream final : public httplib::Stream {
 public:
  SinkStream(std::string request, ByteSink& sink) : request_(std::move(request)), sink_(&sink) {}

  [[nodiscard]] bool is_readable() const override { return true; }
  [[nodiscard]] bool is_writable() const override { return whole_; }
  ssize_t read(char* bytes, std::size_t count) override {
    count = std::min(count, request_.size() - position_);
    std::copy_n(request_.data() + position_, count, bytes);
    position_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* bytes, std::size_t count) override {
    if (whole_) whole_ = sink_->write(bytes, count);
    return whole_ ? static_cast<ssize_t>(count) : -1;
  }
  void get_remote_ip_and_port(std::string& /*ip*/, int& port) const override { port = 0; }
  void get_local_ip_and_port(std::string& /*ip*/, int& port) const override { port = 0; }
  // Below the limit of select(), which httplib looks at; it calls nothing with it.
  [[nodiscard]] socket_t socket() const override { return 0; }
  [[nodiscard]] bool whole() const { return whole_; }

 private:
  std::string request_;
  std::size_t position_ = 0;
  ByteSink* sink_;
  bool whole_ = true;
};

bool send_part(const OpenFile& file, std::size_t offset, std::size_t left,
               httplib::DataSink& sink) {
  std::array<char, kFileChunk> bytes;  // NOLINT(*-member-init): filled by read
  const std::size_t wanted = std::min(left, bytes.size());
  const auto at = static_cast<off_t>(file.part.first + offset);
  const ssize_t count = ::pread(file.descriptor.get(), bytes.data(), wanted, at);
  // A file cut short while it is sent: the missing bytes tell the client.
  return count > 0 && sink.write(bytes.data(), static_cast<std::size_t>(count));
}

/// The library's answer to one request, given beforehand.
class Formatter final : public httplib::Server {
 public:
  Formatter() {
    set_keep_alive_max_count(1000);
    set_keep_alive_timeout(30);
    // Content providers run only while there is a listening socket.
    svr_sock_ = 0;
    set_pre_routing_handler([this](const httplib::Request&, httplib::Response& out) {
      fill(out);
      return HandlerResponse::Handled;
    });
    set_post_routing_handler([](const httplib::Request&, httplib::Response& out) {
      // RFC 9110, 8.6: these have no length of their own.
      if (out.status == 204 || out.status == 304) out.headers.erase("Content-Length");
    });
  }

  bool answer(SinkStream& stream, Ready& ready, Afterwards afterwards) {
    ready_ = &ready;
    bool closed = false;
    const bool sent = process_request(stream, afterwards == Afterwards::close, closed, nullptr);
    ready_ = nullptr;
    return sent && stream.whole();
  }

 private:
  void fill(httplib::Response& out) {
    Response& response = ready_->response;
    out.status = response.status;
    for (const auto& [name, value] : response.headers) out.set_header(name, value);
    out.set_header("Date", http_date(std::time(nullptr)));
    out.set_header("X-Content-Type-Options", "nosniff");
    if (ready_->file) {
      const auto file = ready_->file;
      out.set_content_provider(
          file->part.count, response.content_type,
          [file](std::size_t offset, std::size_t left, httplib::DataSink& sink) {
            return send_part(*file, offset, left, sink);
          });
    } else if (response.stream) {
      out.set_chunked_content_provider(
          response.content_type, [next = response.stream](std::size_t, httplib::DataSink& sink) {
            std::string chunk;
            const bool more = next(chunk);
            if (!chunk.empty() && !sink.write(chunk.data(), chunk.size())) return false;
            if (!more) sink.done();
            return true;
          });
    } else if (!response.content_type.empty()) {
      out.body = std::move(response.body);
      out.set_header("Content-Type", response.content_type);
    }
  }

  Ready* ready_ = nullptr;
};

}  // namespace

Written write_response(ByteSink& sink, const Request& request, Response response,
                       Afterwards afterwards) {
  Ready ready =
      response.file ? open_file(request, std::move(response)) : Ready{std::move(response), nullptr};
  if (request.method == "HEAD") ready.response.stream = nullptr;
  if (ready.response.body.size() >= kWorthCompressing) {
    ready.response.headers.emplace_back("Vary", "Accept-Encoding");
  }
  SinkStream stream(substitute_request(request, ready, afterwards), sink);
  // Construction costs a system call and a few allocations: once per thread.
  thread_local Formatter formatter;
  const bool whole = formatter.answer(stream, ready, afterwards);
  return {ready.response.status, whole};
}

}  // namespace sluice
