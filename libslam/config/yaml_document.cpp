#include <algorithm>
#include <map>
#include <new>
#include <yaml.h>

#include <libslam/config/config_error.hpp>
#include <libslam/config/text_file.hpp>
#include <libslam/config/yaml_document.hpp>

namespace libslam {
namespace {

// Our deepest key is section.group.parameter; the margin only serves a clear message.
constexpr int kDeepestNesting = 8;

FilePlace place_of(const yaml_mark_t& mark) {
  return {static_cast<int>(mark.line) + 1, static_cast<int>(mark.column) + 1};
}

/// Owns one event of libyaml.
class Event {
 public:
  Event() = default;
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;
  ~Event() { yaml_event_delete(&raw_); }

  yaml_event_t* raw() { return &raw_; }
  yaml_event_type_t type() const { return raw_.type; }
  FilePlace place() const { return place_of(raw_.start_mark); }
  std::string text() const {
    return {reinterpret_cast<const char*>(raw_.data.scalar.value), raw_.data.scalar.length};
  }
  bool is_quoted() const { return raw_.data.scalar.style != YAML_PLAIN_SCALAR_STYLE; }

 private:
  yaml_event_t raw_{};
};

/// Turns the events of one text into a tree.
class DocumentReader {
 public:
  DocumentReader(std::string_view text, const std::string& file_name)
      : text_(text), file_name_(file_name) {
    if (yaml_parser_initialize(&parser_) == 0) {
      throw std::bad_alloc();
    }
    yaml_parser_set_encoding(&parser_, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&parser_, reinterpret_cast<const unsigned char*>(text.data()),
                                 text.size());
  }
  DocumentReader(const DocumentReader&) = delete;
  DocumentReader& operator=(const DocumentReader&) = delete;
  ~DocumentReader() { yaml_parser_delete(&parser_); }

  YamlNode read() {
    expect_next();  // stream start
    Event first;
    next(first);
    if (first.type() == YAML_STREAM_END_EVENT) {
      return {};
    }
    Event root;
    next(root);
    YamlNode node = read_node(root, 1);
    if (node.kind != YamlNode::Kind::kMapping && !node.is_null()) {
      fail(node.place, "a mapping of sections is expected (section: on a line of its own)");
    }
    node.kind = YamlNode::Kind::kMapping;
    expect_next();  // document end
    Event last;
    next(last);
    if (last.type() != YAML_STREAM_END_EVENT) {
      fail(last.place(), "a second document begins; one file holds one configuration");
    }
    return node;
  }

 private:
  [[noreturn]] void fail(FilePlace place, const std::string& message) const {
    throw ConfigError(describe_place(file_name_, place) + ": " + message);
  }

  void next(Event& event) {
    if (yaml_parser_parse(&parser_, event.raw()) != 0) {
      return;
    }
    if (parser_.error == YAML_MEMORY_ERROR) {
      throw std::bad_alloc();
    }
    std::string message = "not valid YAML: ";
    message += parser_.problem != nullptr ? parser_.problem : "unreadable text";
    if (parser_.error == YAML_READER_ERROR) {
      fail(place_of_byte(parser_.problem_offset), message);
    }
    if (parser_.context != nullptr) {
      message += std::string(" ") + parser_.context;
    }
    fail(place_of(parser_.problem_mark), message);
  }

  /// Of unreadable bytes libyaml gives no mark, only their offset.
  FilePlace place_of_byte(std::size_t offset) const {
    const std::string_view before = text_.substr(0, offset);
    const std::size_t line_begin = before.rfind('\n') + 1;  // npos + 1 is 0: the first line
    return {static_cast<int>(std::ranges::count(before, '\n')) + 1,
            static_cast<int>(before.size() - line_begin) + 1};
  }

  void expect_next() {
    Event skipped;
    next(skipped);
  }

  YamlNode read_node(Event& event, int depth) {
    if (depth > kDeepestNesting) {
      fail(event.place(), "nested deeper than " + std::to_string(kDeepestNesting) + " levels");
    }
    YamlNode node;
    node.place = event.place();
    switch (event.type()) {
      case YAML_SCALAR_EVENT:
        node.kind = YamlNode::Kind::kScalar;
        node.text = event.text();
        node.quoted = event.is_quoted();
        break;
      case YAML_MAPPING_START_EVENT:
        read_entries(node, depth);
        break;
      case YAML_SEQUENCE_START_EVENT:
        node.kind = YamlNode::Kind::kSequence;
        read_items(node, depth);
        break;
      default:
        fail(node.place, "aliases (*name) are not supported, write the value out");
    }
    return node;
  }

  void read_entries(YamlNode& mapping, int depth) {
    mapping.kind = YamlNode::Kind::kMapping;
    std::map<std::string, int> first_lines;
    for (;;) {
      Event key;
      next(key);
      if (key.type() == YAML_MAPPING_END_EVENT) {
        return;
      }
      if (key.type() != YAML_SCALAR_EVENT) {
        fail(key.place(), "a key must be plain text");
      }
      YamlEntry entry{key.text(), key.place(), {}};
      const auto [first, is_new] = first_lines.emplace(entry.key, entry.place.line);
      if (!is_new) {
        fail(entry.place, "key " + quote_for_message(entry.key) +
                              " is given twice, first in line " + std::to_string(first->second));
      }
      Event value;
      next(value);
      entry.value = read_node(value, depth + 1);
      mapping.entries.push_back(std::move(entry));
    }
  }

  void read_items(YamlNode& sequence, int depth) {
    for (;;) {
      Event item;
      next(item);
      if (item.type() == YAML_SEQUENCE_END_EVENT) {
        return;
      }
      sequence.items.push_back(read_node(item, depth + 1));
    }
  }

  yaml_parser_t parser_{};
  std::string_view text_;
  const std::string& file_name_;
};

}  // namespace

bool YamlNode::is_null() const {
  return kind == Kind::kScalar && !quoted && (text.empty() || text == "~" || text == "null");
}

YamlNode parse_yaml(std::string_view text, const std::string& file_name) {
  return DocumentReader(text, file_name).read();
}

std::string describe_place(const std::string& file_name, FilePlace place) {
  return file_name + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

}  // namespace libslam
