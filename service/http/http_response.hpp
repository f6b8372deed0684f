#pragma once

#include <cstddef>
#include <cstdint>

#include "service/http/message.hpp"

namespace sluice {

/// Where an answer's bytes go.
class ByteSink {
 public:
  ByteSink() = default;
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;
  virtual ~ByteSink() = default;
  /// All or nothing; false when nobody takes them any more.
  virtual bool write(const char* bytes, std::size_t count) = 0;
};

/// Whether another request may follow on the connection.
enum class Afterwards { keep, close };

struct Written {
  int status = 0;
  bool whole = false;  ///< the sink took everything
};

/// Writes the answer to `request`: bodies compressed where the client takes gzip and it is worth
/// it, files with a strong ETag, If-None-Match, If-Range and one Range, streams in chunks. A file
/// that cannot be opened any more becomes a problem. Safe from any thread, one answer per sink.
///
/// The one place that uses cpp-httplib, which formats the answer. It never sees a byte of what a
/// client sent: 0.11.4 reads requests without bounds (see http_head.hpp for what reads them).
Written write_response(ByteSink& sink, const Request& request, Response response,
                       Afterwards afterwards);

}  // namespace sluice
