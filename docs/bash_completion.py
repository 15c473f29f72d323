# SPDX-License-Identifier: Apache-2.0
"""Bash completions from what the programs print for --help. They complete commands, options, and the values of
options that take one of a set of words. Everything else completes to files.
"""
import re

HEAD = """\
# bash completion for {program}, generated from --help
_{program}() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}
  local command={program} word words=
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "$command $word" in
      {commands}) command="$command $word" ;;
    esac
  done
  COMPREPLY=()
  case "$command $previous" in
"""


def choices(entry):
    """The words that an option takes, or none."""
    found = re.search(r" (\w[\w-]*(?:\|\w[\w-]*)+)", entry.name)
    # NAME|INDEX stands for values, csv|jsonl is a set of words.
    return found[1].split("|") if found and found[1] == found[1].lower() else []


def options(one):
    """All names of options of a command."""
    return sorted(name for name in one.flags if name.startswith("-"))


def option_entries(one):
    """Yields the names of each option of a command with its entry: (["-f", "--format"], Entry)."""
    for section, entries in one.sections.items():
        for entry in entries if section not in ("Positionals", "Subcommands") else []:
            yield [name for name in entry.name.split(" ")[0].split(",") if name.startswith("-")], entry


def value_cases(helps):
    """After an option that takes a value: its words, or nothing, so that files complete."""
    lines = []
    for one in helps:
        command = " ".join(one.words)
        for names, entry in option_entries(one):
            pattern = "|".join(f'"{command} {name}"' for name in names if one.flags.get(name))
            if pattern and (words := choices(entry)):
                lines.append(f'    {pattern}) COMPREPLY=($(compgen -W "{" ".join(words)}" -- "$current")); return ;;')
            elif pattern:
                lines.append(f"    {pattern}) return ;;")
    return lines


def script(helps):
    program = helps[0].words[0]
    commands = "|".join(f'"{" ".join(one.words)}"' for one in helps[1:]) or '""'
    lines = [HEAD.format(program=program, commands=commands).rstrip(), *value_cases(helps), "  esac",
             '  case "$command" in']
    for one in helps:
        lines.append(f'    "{" ".join(one.words)}")')
        lines.append(f'      words="{" ".join(options(one))}"')
        if one.subcommands:
            lines.append(f'      [[ $current == -* ]] || words="{" ".join(one.subcommands)}" ;;')
        else:
            lines.append('      [[ $current == -* ]] || words= ;;')
    lines += ["  esac", '  COMPREPLY=($(compgen -W "$words" -- "$current"))', "}",
              f"complete -o default -F _{program} {program}"]
    return "\n".join(lines) + "\n"


def write(programs, out):
    """Writes a file per program. `programs`: per program, the help of it and of all its commands."""
    out.mkdir(parents=True, exist_ok=True)
    for helps in programs:
        (out / helps[0].words[0]).write_text(script(helps))
