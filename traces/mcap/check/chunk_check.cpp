#include "traces/mcap/check/chunk_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace vestige::mcap {

namespace {

bool before(const MessageIndexEntry& a, const MessageIndexEntry& b) {
  return a.offset != b.offset ? a.offset < b.offset : a.log_time < b.log_time;
}

bool same(const MessageIndexEntry& a, const MessageIndexEntry& b) {
  return a.offset == b.offset && a.log_time == b.log_time;
}

}  // namespace

void MessageIndexCheck::begin(Subject subject) {
  end();
  subject_ = subject;
}

void MessageIndexCheck::take_message(const Message& message, std::uint64_t offset_in_chunk) {
  channels_[message.channel_id].in_chunk.push_back({.log_time = message.log_time, .offset = offset_in_chunk});
}

void MessageIndexCheck::report(const RecordPlace& place, std::string what) {
  problems_.add({.offset = place.offset,
                 .bytes = place.end() - place.offset,
                 .what = fmt::format("MessageIndex: {}", what),
                 .consequence = "readers that use it miss or misread messages; `vestige recover` writes a new one"});
}

void MessageIndexCheck::take_index(const RecordPlace& place, const MessageIndex& index) {
  if (subject_ == Subject::kNone) report(place, "does not follow a Chunk");
  if (subject_ != Subject::kReadChunk) return;
  last_index_ = place;
  const auto channel = channels_.find(index.channel_id);
  if (channel == channels_.end()) {
    if (!index.entries.empty())
      report(place, fmt::format("is for channel {}, but the chunk before it has no message of that channel",
                                index.channel_id));
    return;
  }
  channel->second.indexed = true;
  const std::vector<MessageIndexEntry>& actual = channel->second.in_chunk;  // by offset
  std::vector<MessageIndexEntry> claimed = index.entries;
  std::sort(claimed.begin(), claimed.end(), before);
  if (claimed.size() != actual.size()) {
    report(place, fmt::format("lists {} messages of channel {}, but the chunk before it has {}", claimed.size(),
                              index.channel_id, actual.size()));
    return;
  }
  const auto [wrong, right] = std::mismatch(claimed.begin(), claimed.end(), actual.begin(), same);
  if (wrong == claimed.end()) return;
  report(place, fmt::format("lists a message at time {} and offset {}, but the chunk before it has one at time {} and "
                            "offset {}",
                            wrong->log_time, wrong->offset, right->log_time, right->offset));
}

void MessageIndexCheck::end() {
  if (subject_ == Subject::kReadChunk && last_index_) {
    for (const auto& [id, entries] : channels_)
      if (!entries.indexed)
        report(*last_index_,
               fmt::format("the chunk before it also has messages of channel {}, but no MessageIndex lists them", id));
  }
  subject_ = Subject::kNone;
  channels_.clear();
  last_index_.reset();
}

}  // namespace vestige::mcap
