#include "cli/help/completion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace vestige::help {

namespace {

constexpr const char* kBash = R"(# bash completion of vestige. For this shell: source <(vestige completion bash)
_vestige() {
  local current=${COMP_WORDS[COMP_CWORD]} word meaning
  COMPREPLY=()
  while IFS=$'\t' read -r word meaning; do
    if [ "$word" = : ]; then
      compopt -o filenames 2>/dev/null
      mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$current")
    else
      COMPREPLY+=("$word")
    fi
  done < <("${COMP_WORDS[0]}" complete "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -F _vestige vestige
)";

constexpr const char* kZsh = R"(#compdef vestige
# zsh completion of vestige. For this shell: source <(vestige completion zsh)
_vestige() {
  local -a described
  local line files=
  for line in "${(@f)$("${words[1]}" complete "${(@)words[2,CURRENT]}" 2>/dev/null)}"; do
    if [[ $line == : ]]; then
      files=1
    elif [[ -n $line ]]; then
      described+=("${${line//:/\\:}/$'\t'/:}")
    fi
  done
  (( $#described )) && _describe vestige described
  [[ -n $files ]] && _files
}
if [[ $funcstack[1] == _vestige ]]; then
  _vestige "$@"
else
  compdef _vestige vestige
fi
)";

constexpr const char* kFish = R"(# fish completion of vestige. For this shell: vestige completion fish | source
function __vestige_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    for line in ($words[1] complete $words[2..] "$current" 2>/dev/null)
        if test "$line" = :
            __fish_complete_path "$current"
        else
            echo $line
        end
    end
end
complete -c vestige -f -a '(__vestige_complete)'
)";

bool fits(const std::string& candidate, const std::string& typed) {
  return candidate.starts_with(typed);
}

std::string line_of(const std::string& word, const std::string& meaning) {
  return fmt::format("{}\t{}\n", word, meaning.substr(0, meaning.find('\n')));
}

std::string values(const FlagTable& flag, const std::string& typed) {
  std::string lines;
  for (const FixedValue& value : fixed_values(flag))
    if (fits(value.word, typed)) lines += line_of(value.word, value.meaning);
  return takes_path(flag) ? lines + ":\n" : lines;
}

const FlagTable* find_flag(const CommandTable& command, const std::string& word) {
  for (const FlagTable& flag : command.flags)
    if (!flag.positional && std::ranges::find(flag.names, word) != flag.names.end()) return &flag;
  return nullptr;
}

/// Of a flag with two names the long one is offered, unless the short one is typed out.
std::string flags(const CommandTable& command, const std::vector<std::string>& before, const std::string& typed) {
  std::string lines;
  for (const FlagTable& flag : command.flags) {
    const bool used =
        std::ranges::any_of(before, [&](const std::string& word) { return find_flag(command, word) == &flag; });
    if (flag.positional || used) continue;
    if (fits(flag.names.back(), typed)) {
      lines += line_of(flag.names.back(), flag.description);
    } else if (fits(flag.names.front(), typed)) {
      lines += line_of(flag.names.front(), flag.description);
    }
  }
  return lines;
}

/// `words` follow the command's own name.
std::string complete_in(const CommandTable& command, const std::vector<std::string>& words) {
  const std::string typed = words.empty() ? "" : words.back();
  const std::vector<std::string> before(words.begin(), words.empty() ? words.end() : words.end() - 1);
  for (std::size_t i = 0; i < before.size(); ++i)
    for (const CommandTable& verb : command.verbs)
      if (verb.verb == before[i])
        return complete_in(verb, {words.begin() + static_cast<std::ptrdiff_t>(i) + 1, words.end()});
  if (!before.empty())
    if (const FlagTable* flag = find_flag(command, before.back()); flag != nullptr && !flag->value.empty())
      return values(*flag, typed);
  if (typed.starts_with('-')) return flags(command, before, typed);
  std::string lines;
  for (const CommandTable& verb : command.verbs)
    if (fits(verb.verb, typed)) lines += line_of(verb.verb, verb.summary);
  for (const FlagTable& flag : command.flags)
    if (flag.positional) lines += values(flag, typed);
  return lines;
}

}  // namespace

std::string completions(const CommandTable& program, const std::vector<std::string>& words) {
  return complete_in(program, words);
}

std::string completion_script(const std::string& shell) {
  if (shell == "bash") return kBash;
  return shell == "zsh" ? kZsh : kFish;
}

}  // namespace vestige::help
