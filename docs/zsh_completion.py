# SPDX-License-Identifier: Apache-2.0
"""zsh completions from what the programs print for --help, with the first line of each description."""
from bash_completion import choices, option_entries

HEAD = """\
#compdef {program}
# zsh completion for {program}, generated from --help
_{program}() {{
  local command={program} word previous=${{words[CURRENT-1]}}
  local -a found
  for word in "${{(@)words[2,CURRENT-1]}}"; do
    case "$command $word" in
      ({commands}) command="$command $word" ;;
    esac
  done
  case "$command $previous" in
"""


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def described(word, text):
    """An element for _describe: a colon separates the word from its description."""
    return quoted(word.replace(":", "\\:") + ":" + text.split("\n")[0])


def value_cases(helps):
    for one in helps:
        command = " ".join(one.words)
        for names, entry in option_entries(one):
            takers = [name for name in names if one.flags.get(name)]
            if takers:
                pattern = "|".join(quoted(f"{command} {name}") for name in takers)
                words = choices(entry)
                yield f"    ({pattern}) {'compadd -- ' + ' '.join(words) if words else '_files'}; return ;;"


def script(helps):
    program = helps[0].words[0]
    commands = "|".join(quoted(" ".join(one.words)) for one in helps[1:]) or "''"
    lines = [HEAD.format(program=program, commands=commands).rstrip(), *value_cases(helps), "  esac",
             '  case "$command" in']
    for one in helps:
        about = {entry.name.split()[0]: entry.text for entry in one.entries("Subcommands")}
        options = [described(name, entry.text) for names, entry in option_entries(one) for name in names]
        lines += [f"    ({quoted(' '.join(one.words))})", "      if [[ ${words[CURRENT]} == -* ]]; then",
                  f"        found=({' '.join(options)})", "        _describe option found"]
        if about:
            lines += ["      else", f"        found=({' '.join(described(*item) for item in about.items())})",
                      "        _describe command found"]
        else:
            lines += ["      else", "        _files"]
        lines.append("      fi ;;")
    lines += ["  esac", "}", f'_{program} "$@"']
    return "\n".join(lines) + "\n"


def write(programs, out):
    """Writes a file per program. `programs`: per program, the help of it and of all its commands."""
    out.mkdir(parents=True, exist_ok=True)
    for helps in programs:
        (out / f"_{helps[0].words[0]}").write_text(script(helps))
