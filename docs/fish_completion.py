# SPDX-License-Identifier: Apache-2.0
"""fish completions from what the programs print for --help, with the first line of each description."""
from bash_completion import choices, option_entries

HEAD = """\
# fish completion for {program}, generated from --help
function __{program}_is
    # Whether the commands on the line are exactly these.
    set -l command {program}
    for word in (commandline -opc)[2..]
        switch "$command $word"
            case {commands}
                set command "$command $word"
        end
    end
    test "$command" = "$argv"
end
"""


def quoted(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def option_line(start, name, takes_value, entry):
    """`complete` for one name of an option."""
    kind = f"-l {name[2:]}" if name.startswith("--") else f"-s {name[1:]}"
    words = choices(entry)
    value = f" -x -a {quoted(' '.join(words))}" if words else " -r -F" if takes_value else ""
    return f"{start} {kind}{value} -d {quoted(entry.text.splitlines()[0] if entry.text else '')}"


def script(helps):
    program = helps[0].words[0]
    commands = " ".join(quoted(" ".join(one.words)) for one in helps[1:]) or "''"
    lines = [HEAD.format(program=program, commands=commands).rstrip()]
    for one in helps:
        start = f"complete -c {program} -n '__{program}_is {' '.join(one.words)}'"
        for entry in one.entries("Subcommands"):
            lines.append(f"{start} -f -a {entry.name.split()[0]} -d {quoted(entry.text.splitlines()[0])}")
        lines += [option_line(start, name, one.flags.get(name), entry)
                  for names, entry in option_entries(one) for name in names]
    return "\n".join(lines) + "\n"


def write(programs, out):
    """Writes a file per program. `programs`: per program, the help of it and of all its commands."""
    out.mkdir(parents=True, exist_ok=True)
    for helps in programs:
        (out / f"{helps[0].words[0]}.fish").write_text(script(helps))
