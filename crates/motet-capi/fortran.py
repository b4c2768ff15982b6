#!/usr/bin/env python3
"""Writes the Fortran module fortran/motet.f90 from include/motet.h and the template fortran/motet.in.f90.

    crates/motet-capi/fortran.py            writes the module
    crates/motet-capi/fortran.py --check    fails, and prints the difference, where the module is out of date

The template is the hand-written part of the module: the types with procedures, and these procedures. Four of its
lines are replaced by what the header declares, with the comments of the header:

    !{constants}     all constants
    !{types}         all structs, without the prefix `motet_`. Options are structs twice: as C has them, with the
                     prefix `c_`, and as Fortran has them, with arrays of texts and numbers, and with a pointer
                     to each object
    !{interfaces}    all functions and types of functions, with the prefix `c_` for `motet_`
    !{conversions}   `give_NAME` for all options: those of Fortran as C has them

Rules that the header has to follow, beyond those of C:
- A comment right above a declaration belongs to it, and so does one behind a member or a constant.
- `default X` in the comment of a member is its initial value, and so is the -1 of `-1 where`; others are 0 or NULL.
- A pointer to numbers is an array where a count, an `int64_t`, stands after it, and a single number otherwise.
- The count of an array in options is the member behind it: the name of the array with `n_`.
"""
import difflib
import re
import sys
import textwrap
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
HEADER = HERE / "include" / "motet.h"
TEMPLATE = HERE / "fortran" / "motet.in.f90"
MODULE = HERE / "fortran" / "motet.f90"
WIDTH = 110

NUMBERS = {
    "int32_t": "integer(c_int32_t)",
    "motet_status": "integer(c_int32_t)",
    "int64_t": "integer(c_int64_t)",
    "size_t": "integer(c_size_t)",
    "double": "real(c_double)",
}
# Types whose name in Fortran is not theirs without the prefix.
RENAMED = {"motet_step": "moving_step"}
# Arrays that may be NULL: passed as addresses.
NULLABLE = {"is_room", "is_membrane"}


@dataclass
class Constant:
    name: str
    number: str
    comment: str


@dataclass
class Variable:
    """A member of a struct or a parameter of a function."""

    type: str  # without `const` and pointers
    pointers: int
    is_const: bool  # what the first pointer points to
    name: str
    length: str  # of an array of a fixed size; empty for others
    comment: str = ""


@dataclass
class Struct:
    name: str
    comment: str
    members: list


@dataclass
class Function:
    name: str
    comment: str
    result: Variable
    parameters: list


@dataclass
class Header:
    enums: list = field(default_factory=list)  # each its comment and its constants
    structs: list = field(default_factory=list)
    functions: list = field(default_factory=list)
    callbacks: list = field(default_factory=list)  # types of functions


# ---- Reading ------------------------------------------------------------------------------------------------

COMMENT = r"/\*(?:[^*]|\*(?!/))*\*/"
DECLARATIONS = [
    ("comment", re.compile(COMMENT)),
    ("callback", re.compile(r"typedef (\w+) \(\*(\w+)\)\(([^()]*)\);")),
    ("define", re.compile(r"#define (\w+) (\d+)\n")),
    ("skipped", re.compile(r"#[^\n]*\n|extern \"C\" \{|typedef \w+ \w+;|typedef struct (\w+) \1;|\}")),
    ("enum", re.compile(r"enum \{(.*?)\};", re.S)),
    ("struct", re.compile(r"typedef struct (\w+) \{(.*?)\} \1;", re.S)),
    ("function", re.compile(r"([\w ]+?[ *]+)(\w+)\(([^()]*)\);")),
]


def words(comment):
    """The text of a comment on one line."""
    inner = comment.strip().removeprefix("/*").removesuffix("*/")
    return " ".join(re.sub(r"^\s*\*", "", line).strip() for line in inner.splitlines()).strip()


def variable(text, comment=""):
    """`const double *points` and the like."""
    match = re.fullmatch(r"(const )?(\w+) ?([*const ]*?)(\w*)(?:\[(\d+)\])?", " ".join(text.split()))
    if not match:
        raise SystemExit(f"motet.h: cannot read `{text}`")
    const, kind, pointers, name, length = match.groups()
    return Variable(kind, pointers.count("*"), bool(const), name, length or "", comment)


def members(body):
    found = re.findall(rf"([^;/]+);[ \t]*({COMMENT})?", body)
    return [variable(text.strip(), words(comment)) for text, comment in found]


def constants(body):
    found = re.findall(rf"(\w+) = (-?\d+),?[ \t]*({COMMENT})?", body)
    return [Constant(name, number, words(comment)) for name, number, comment in found]


def parameters(text):
    return [] if text == "void" else [variable(one) for one in text.split(",")]


def read(text):
    """The declarations of the header, in its order."""
    header = Header([("The version of the header.", [])])
    at, comment = 0, ""
    while at < len(text):
        if text[at].isspace():
            # A blank line separates a comment from what follows.
            blank = re.compile(r"\s*").match(text, at)
            comment = "" if blank[0].count("\n") > 1 else comment
            at = blank.end()
            continue
        matches = ((kind, pattern.match(text, at)) for kind, pattern in DECLARATIONS)
        kind, match = next((pair for pair in matches if pair[1]), (None, None))
        if match is None:
            raise SystemExit(f"motet.h: cannot read line {text.count(chr(10), 0, at) + 1}")
        at = match.end()
        if kind == "comment":
            comment = words(match[0])
            continue
        if kind == "define":
            header.enums[0][1].append(Constant(match[1], match[2], ""))
        elif kind == "enum":
            header.enums.append((comment, constants(match[1])))
        elif kind == "struct":
            header.structs.append(Struct(match[1], comment, members(match[2])))
        elif kind == "callback":
            result = variable(match[1])
            header.callbacks.append(Function(match[2], comment, result, parameters(match[3])))
        elif kind == "function":
            result = variable(match[1])
            header.functions.append(Function(match[2], comment, result, parameters(match[3])))
        comment = ""
    return header


# ---- Writing ------------------------------------------------------------------------------------------------


def comment_lines(indent, comment):
    return textwrap.wrap(
        comment,
        WIDTH,
        initial_indent=f"{indent}! ",
        subsequent_indent=f"{indent}! ",
        break_long_words=False,
        break_on_hyphens=False,
    )


def statement(indent, text):
    """The lines of a statement, broken after commas and before `bind`."""
    lines, line = [], indent
    for part in re.split(r"(?<=, )(?!name=)|(?<= )(?=bind)", text):
        if len(line + part.rstrip()) > WIDTH - 2:
            lines.append(f"{line}&")
            line = f"{indent}    "
        line += part
    return [*lines, line]


def type_name(name):
    return RENAMED.get(name, name.removeprefix("motet_"))


def initial(member):
    """The initial value of a member."""
    if member.pointers:
        return "c_null_ptr"
    found = re.search(r"\bdefault (MOTET_\w+|-?\d[\d.]*(?:e-?\d+)?)", member.comment)
    found = found or re.search(r"(-1) where", member.comment)
    value = found[1] if found else "0"
    if member.type != "double" or value == "0":
        return value
    return f"{value}_c_double" if re.search("[.e]", value) else f"{value}.0_c_double"


def write_constants(header):
    for comment, listed in header.enums:
        yield from comment_lines("  ", comment)
        for one in listed:
            yield from comment_lines("  ", f"{one.name}: {one.comment}") if one.comment else ()
            yield f"  integer(c_int32_t), parameter, public :: {one.name} = {one.number}"
        yield ""


def is_options(struct):
    return struct.name.endswith("_options")


def type_in_c(struct):
    """The name of the type that C has."""
    return ("c_" if is_options(struct) else "") + type_name(struct.name)


def write_types(header):
    for struct in header.structs:
        yield from comment_lines("  ", f"{struct.comment} As C has them." if is_options(struct) else struct.comment)
        yield f"  type, bind(c) :: {type_in_c(struct)}"
        for member in struct.members:
            yield from () if is_options(struct) else comment_lines("    ", member.comment)
            kind = "type(c_ptr)" if member.pointers else NUMBERS[member.type]
            shape = f"({member.length})" if member.length else ""
            yield f"    {kind} :: {member.name}{shape} = {initial(member)}"
        yield "  end type"
        yield ""
        if is_options(struct):
            yield from write_options(struct)


def own_members(struct):
    """The members of options that Fortran has: neither the size nor counts of arrays."""
    arrays = {member.name for member in struct.members if member.pointers}
    return [one for one in struct.members[1:] if one.name.removeprefix("n_") not in arrays or one.pointers]


def write_options(struct):
    yield from comment_lines("  ", struct.comment)
    yield f"  type, public :: {type_name(struct.name)}"
    for member in own_members(struct):
        yield from comment_lines("    ", member.comment)
        if member.type == "char":
            yield f"    character(MOTET_NAME_LENGTH), allocatable :: {member.name}(:)"
        elif member.pointers and member.type in NUMBERS:
            yield f"    {NUMBERS[member.type]}, allocatable :: {member.name}(:)"
        elif member.pointers:
            yield f"    type({type_name(member.type)}), pointer :: {member.name} => null()"
        else:
            yield f"    {NUMBERS[member.type]} :: {member.name} = {initial(member)}"
    yield "  end type"
    yield ""


def write_conversions(header):
    for struct in filter(is_options, header.structs):
        name, own = type_name(struct.name), own_members(struct)
        lists = [member.name for member in own if member.type == "char"]
        yield f"  subroutine give_{name}(options, given, kept)"
        yield f"    type({name}), intent(in), optional, target :: options"
        yield f"    type({type_in_c(struct)}), intent(out) :: given"
        yield "    type(texts), allocatable, intent(out), target :: kept(:)"
        yield f"    allocate(kept({len(lists)}))"
        yield "    given%size = c_sizeof(given)"
        yield "    if (.not. present(options)) return"
        for member in own:
            one = member.name
            if member.type == "char":
                yield f"    call keep(options%{one}, kept({lists.index(one) + 1}), given%{one}, given%n_{one})"
            elif member.pointers and member.type in NUMBERS:
                yield f"    if (allocated(options%{one})) then"
                yield f"      given%n_{one} = size(options%{one}, kind=c_int64_t)"
                yield f"      if (given%n_{one} > 0) given%{one} = c_loc(options%{one})"
                yield "    end if"
            elif member.pointers:
                yield f"    if (associated(options%{one})) given%{one} = options%{one}%handle"
            else:
                yield f"    given%{one} = options%{one}"
        yield "  end subroutine"
        yield ""


def declaration(one, has_count_after, structs):
    """How a parameter is declared in Fortran: its attributes, and its shape."""
    intent = "in" if one.is_const else "inout"
    if one.name in NULLABLE:
        return "type(c_ptr), value", ""
    if one.type in structs and one.pointers == 1:
        return f"type({structs[one.type]}), intent({intent})", ""
    if one.type not in NUMBERS and one.pointers == 0:
        return "type(c_funptr), value", ""
    if one.type == "char" and one.pointers == 1:
        return f"character(kind=c_char), intent({intent})", "(*)"
    if one.type in NUMBERS and one.length:
        return f"{NUMBERS[one.type]}, intent({intent})", f"({one.length})"
    if one.type in NUMBERS and one.pointers == 1:
        is_array = has_count_after or one.is_const
        return f"{NUMBERS[one.type]}, intent({intent if is_array else 'out'})", "(*)" if is_array else ""
    if one.type in NUMBERS and one.pointers == 0:
        return f"{NUMBERS[one.type]}, value", ""
    # Handles, by value, and places and arrays of addresses.
    if one.pointers == 1:
        return "type(c_ptr), value", ""
    return f"type(c_ptr), intent({intent})", "(*)" if one.is_const else ""


def write_interface(function, structs, is_linked=True):
    name = "c_" + function.name.removeprefix("motet_")
    # A parameter does not hide the type that it has.
    names = [
        f"{one.name}_" if one.name == structs.get(one.type) else one.name
        for one in function.parameters
    ]
    is_function = function.result.pointers > 0 or function.result.type != "void"
    what = "function" if is_function else "subroutine"
    yield from comment_lines("    ", function.comment)
    bound = f", name='{function.name}'" if is_linked else ""
    yield from statement("    ", f"{what} {name}({', '.join(names)}) bind(c{bound})")
    yield "      import"
    grouped = []
    for i, one in enumerate(function.parameters):
        rest = function.parameters[i + 1 :]
        has_count_after = any(other.type == "int64_t" and other.pointers == 0 for other in rest)
        attributes, shape = declaration(one, has_count_after, structs)
        if not grouped or grouped[-1][0] != attributes:
            grouped.append((attributes, []))
        grouped[-1][1].append(names[i] + shape)
    for attributes, listed in grouped:
        yield from statement("      ", f"{attributes} :: {', '.join(listed)}")
    if is_function:
        kind = "type(c_ptr)" if function.result.pointers else NUMBERS[function.result.type]
        yield f"      {kind} :: {name}"
    yield f"    end {what}"


def write_interfaces(header):
    structs = {struct.name: type_in_c(struct) for struct in header.structs}
    yield "  abstract interface"
    for function in header.callbacks:
        yield from write_interface(function, structs, is_linked=False)
    yield "  end interface"
    yield ""
    yield "  interface"
    for function in header.functions:
        yield from write_interface(function, structs)
    yield "  end interface"
    yield ""


def module():
    header = read(HEADER.read_text())
    sections = {
        "  !{constants}": write_constants,
        "  !{types}": write_types,
        "  !{interfaces}": write_interfaces,
        "  !{conversions}": write_conversions,
    }
    lines = ["! Written by fortran.py from motet.h and motet.in.f90. Change these, not this file.", "!"]
    for line in TEMPLATE.read_text().splitlines():
        lines += sections.pop(line)(header) if line in sections else [line]
    if sections:
        raise SystemExit(f"motet.in.f90 has no line {', '.join(sections)}")
    return "\n".join(lines) + "\n"


def main(arguments):
    if arguments not in ([], ["--check"]):
        raise SystemExit(__doc__)
    new = module()
    if not arguments:
        MODULE.write_text(new)
        return
    old = MODULE.read_text()
    if old != new:
        difference = difflib.unified_diff(old.splitlines(), new.splitlines(), "motet.f90", "motet.h", lineterm="")
        print("\n".join(difference))
        raise SystemExit("motet.f90 is out of date: run crates/motet-capi/fortran.py")


if __name__ == "__main__":
    main(sys.argv[1:])
