#pragma once
// A YAML document as a tree that knows where each of its parts stands in the file.
//
// The parser is libyaml. mrpt::containers::yaml is not used: of MRPT 2.5.8 it accepts broken
// documents
// (`a: 1 b: 2`, an unclosed `[`), drops the first of two equal keys and every second document,
// refuses the empty text `''`, and prints to stderr.

#include <string>
#include <string_view>
#include <vector>

namespace libslam {

/// Where something stands in a file; both count from 1.
struct FilePlace {
  int line = 1;
  int column = 1;
};

struct YamlEntry;

/// A value: a scalar with its text, a mapping with its entries in file order, or a sequence.
struct YamlNode {
  enum class Kind { kScalar, kMapping, kSequence };

  Kind kind = Kind::kMapping;
  FilePlace place;
  std::string text;                ///< of a scalar, quotes and escapes resolved
  bool quoted = false;             ///< the scalar was written in quotes or as a block
  std::vector<YamlEntry> entries;  ///< of a mapping
  std::vector<YamlNode> items;     ///< of a sequence

  /// A plain scalar that stands for nothing: `key:`, `key: ~` or `key: null`.
  bool is_null() const;
};

/// One `key: value` of a mapping.
struct YamlEntry {
  std::string key;
  FilePlace place;  ///< of the key
  YamlNode value;
};

/// Parses one document whose root is a mapping; an empty text is an empty mapping.
///
/// Throws ConfigError "`file_name`:line:column: ..." on a syntax error, invalid UTF-8, a key given
/// twice in one mapping, a key that is no scalar, an alias, a second document, a root that is no
/// mapping, or nesting deeper than 8.
YamlNode parse_yaml(std::string_view text, const std::string& file_name);

/// "file:line:column" as error messages begin.
std::string describe_place(const std::string& file_name, FilePlace place);

}  // namespace libslam
