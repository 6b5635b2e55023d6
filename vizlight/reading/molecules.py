"""Molecules and crystals of PDB, CIF and XYZ files: one state of their atoms, joined by bonds."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyvista as pv
import scipy
from vtkmodules.vtkCommonDataModel import vtkMolecule

from vizlight import _check
from vizlight._types import Array, Bools, Foreign, Indices
from vizlight.mesh import meaning
from vizlight.model import formulas
from vizlight.reading import file_parts, ribbons

#: Atomic numbers of elements that are no metals.
NO_METALS = [1, 2, *range(5, 11), *range(14, 19), *range(32, 37), *range(52, 55), 85, 86]
#: Largest luma of the colour of an element, and the greys of hydrogen and carbon, which are white
#: and black in models.
PALE, GREYS = 0.7, {1: 0.9, 6: 0.3}
#: A coordinate in its columns.
_PLACE = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)\s*")
#: Symbol of an atom at the start of a line of an XYZ file.
_SYMBOL = re.compile(r"[A-Za-z]{1,3}\d*$")
#: Point arrays of a PDB file: their columns, and what stands for none.
_NUMBERS = {"residue": (22, 26, 0), "occupancy": (54, 60, 1.0), "b_factor": (60, 66, 0.0)}
#: Records of a PDB file, the kind of which they tell, and the columns of the chain and its ends.
_STRUCTURES = (("HELIX ", ribbons.HELIX, 19, 21, 33), ("SHEET ", ribbons.STRAND, 21, 22, 33))
#: Field arrays of a volume with the atomic numbers and the places of the molecule in it.
NUMBERS, PLACES = "atom_numbers", "atom_places"
#: Field array of a crystal with the edges of its cell, and attribute of ``atom_type`` with the name
#: of the molecule or the formula of the crystal, and items of CIF that have it.
CELL, NAME = "unit_cell", "molecule"
_FORMULAS = (
    "_chemical_name_mineral", "_chemical_formula_structural", "_chemical_formula_sum",
)  # fmt: skip
#: Name of their marks, and numbers of them from which a molecule is a long chain: of all, and of
#: those of a protein, which folds from about as many on.
BACKBONE, LONG, FOLDED = "backbone_mask", 60, 25
#: Mark of the oxygen of an amino acid, and its largest distance in angstroms from its carbon.
OXYGEN, _NEAR = 2, 3.0
#: Length from which a word of a name is no abbreviation.
_SPELLED = 6
#: Name of the kinds of secondary structure of which a file tells.
STRUCTURE = "secondary_structure"
#: Atomic number of the atoms of backbones of proteins.
PROTEIN = 6
#: Largest distance in angstroms of two that follow each other, in proteins and in nucleic acids,
#: and radii of their tubes.
_APART, _TUBES = {PROTEIN: 4.5, 15: 9.0}, (0.4, 0.8)
#: Number of residues from which they are many, which are drawn less finely.
MANY = 5000
#: Largest deviation in angstroms of the length of a bond from the sum of the radii of its atoms,
#: and least share of such bonds where most atoms have none.
OFF, USUAL = 0.25, 0.75
#: Share of an edge of a cell up to which places are one.
ROUNDED = 1e-3
#: Name of the array of the names of residues, names of amino acids and nucleotides in the Protein
#: Data Bank and in force fields, and those of water.
RESIDUE = "residue_name"
_OF_CHAINS = {
    "A", "ACE", "ADE", "ALA", "ARG", "ASH", "ASN", "ASP", "ASX", "C", "CYM", "CYS", "CYT",
    "CYX", "DA", "DC", "DG", "DI", "DT", "DU", "G", "GLH", "GLN", "GLU", "GLX", "GLY", "GUA",
    "HID", "HIE", "HIP", "HIS", "HSD", "HSE", "HSP", "I", "ILE", "LEU", "LYN", "LYS", "MET",
    "MSE", "NH2", "NMA", "NME", "PHE", "PRO", "PYL", "SEC", "SER", "T", "THR", "THY", "TRP",
    "TYR", "U", "UNK", "URA", "VAL",
}  # fmt: skip
WATERS = {"HOH", "WAT", "H2O", "DOD", "SOL", "TIP", "TIP3", "TIP4", "TP3", "SPC"}
#: Most atoms beside chains that are drawn.
MOST_BESIDE = 1000
#: Names and elements of the atoms that stand for a residue of a protein and of a nucleic acid.
_BACKBONE = {("CA", "C"), ("P", "P")}
#: Names of an atom of the sugar of a nucleotide.
_SUGAR = {"C3'", "C3*"}


def of_pdb(path: Path) -> pv.PolyData:
    """Return the atoms of the first model of a PDB file, bonds by the distances of these atoms.

    VTK's reader joins the atoms of all models with each other, leaves out hydrogen, and takes the
    columns of old files for elements, which makes false bonds.

    Bonds, and points of atoms without any, have ``atom_type``, the atomic number, ``radius``, that
    of van der Waals, ``residue``, ``residue_name``, ``chain``, ``occupancy``, ``b_factor`` and
    ``backbone_mask``, 1 for the atom that stands for a residue and 2 for the oxygen of its peptide;
    where the file tells of helices and strands, ``secondary_structure``. Of atoms with several
    places the first is taken.
    """
    data = path.read_bytes()
    file_parts.warn_of_last_line(path, data)
    lines = data.decode("latin-1").splitlines()
    ends = _ends_of_states(lines)
    if len(ends) > 1:
        warn_of_states(path, len(ends))
    atoms, places = [], []
    for line in lines[: ends[0] if ends else None]:
        if not line.startswith(("ATOM", "HETATM")):
            continue
        columns = [line[i : i + 8] for i in (30, 38, 46)]
        # Columns are fixed, and 80 at most: a word that is too long moves those after it.
        fits = 54 <= len(line.rstrip()) <= 80 and re.match(r"\s*[+-]?\d", line[22:26])
        if not fits or not all(map(_PLACE.fullmatch, columns)):
            raise ValueError(f"no numbers in the columns of the line {line[:60]!r}")
        if line[16:17] in (" ", "A", "1"):
            atoms.append(line)
            places.append([float(column) for column in columns])
    elements = [_element(line) for line in atoms]
    mesh = joined(elements, places, name=_compound(lines))
    for name, (first, last, none) in _NUMBERS.items():
        words = [line[first:last].strip() for line in atoms]
        try:
            mesh.point_data[name] = [type(none)(word) if word else none for word in words]
        except ValueError:
            continue  # numbers of residues may have letters
    residues = [line[17:21].strip() for line in atoms]
    names = [_name(line[12:16], residue) for line, residue in zip(atoms, residues, strict=True)]
    attach_chains(
        mesh, [line[21:22] for line in atoms],
        [(name, each.upper()) for name, each in zip(names, elements, strict=True)],
        residues,
        _records(lines),
    )  # fmt: skip
    return mesh


def _ends_of_states(lines: Sequence[str]) -> list[int]:
    """Return the lines after the models of a PDB file, or after states of as many atoms each."""
    models = [i for i, line in enumerate(lines) if line.startswith("ENDMDL")]
    ends = [i for i, line in enumerate(lines) if line.rstrip() == "END"]
    parts = [lines[start:end] for start, end in zip([0, *ends], [*ends, None], strict=True)]
    counts = {sum(line.startswith(("ATOM", "HETATM")) for line in part) for part in parts[:-1]}
    return models or (ends if len(counts) == 1 else [])


def _name(columns: str, residue: str) -> str:
    """Return the name of an atom of a residue.

    A calcium ion has its name one column before that of a carbon, but some programs begin all names
    in that column.
    """
    return columns.strip() if columns.startswith(" ") or residue in _OF_CHAINS else columns


def _compound(lines: Sequence[str]) -> str:
    """Return the name of the only molecule of a file, in lower case but for short words."""
    text = " ".join(line[10:70].strip() for line in lines if line.startswith("COMPND"))
    names = re.findall(r"MOLECULE: *([^;]+)", text) if "MOL_ID" in text else [text]
    if len(names) != 1:
        return ""
    words = (word if len(word) < _SPELLED else word.lower() for word in names[0].split())
    name = " ".join(words)
    return name[:1].upper() + name[1:]


def _records(lines: Sequence[str]) -> list[tuple[str, int, int, int]]:
    """Return the chain, the first and last residue, and the kind of helices and strands."""
    found = []
    for line in lines:
        for word, kind, *starts in _STRUCTURES:
            numbers = [line[start : start + 4].strip() for start in starts[1:]]
            if line.startswith(word) and all(re.fullmatch(r"-?\d+", each) for each in numbers):
                found.append((line[starts[0]], int(numbers[0]), int(numbers[1]), kind))
    return found


def of_cif(path: Path) -> pv.PolyData:
    """Return the atoms of a CIF file: of the first model of a macromolecule, or of a unit cell.

    gemmi reads the file. Bonds and atoms are as of :func:`of_pdb`; those of a crystal, in all
    places of its cell by its symmetry, have ``occupancy`` alone and the field array ``unit_cell``,
    its edges. Of elements that share a place the most frequent counts.
    """
    import gemmi

    with file_parts.errors_of_gemmi(path):
        document: Foreign = gemmi.cif.read(str(path))
        block = next((each for each in document if len(each.find_loop("_atom_site.id"))), None)
        structure = None if block is None else gemmi.make_structure_from_block(block)
        crystals = [gemmi.make_small_structure_from_block(each) for each in document]
    if structure is not None:
        return _macromolecule(structure, path)
    number = next((i for i, each in enumerate(crystals) if len(each.sites)), None)
    if number is None:
        raise ValueError("it has no atoms")
    crystal, items = crystals[number], map(document[number].find_value, _FORMULAS)
    words = (gemmi.cif.as_string(item).replace(" ", "") for item in items if item)
    sites = sorted(crystal.get_all_unit_cell_sites(), key=lambda site: -float(site.occ))
    shares = np.array([site.fract.tolist() for site in sites]) % 1
    # Numbers such as 0.3333 are rounded; what lies on a side of the cell lies on the other, too.
    shares[shares > 1 - ROUNDED] -= 1
    _, first = np.unique(np.rint(shares / ROUNDED), axis=0, return_index=True)
    rows, shares = first, shares[first]
    for axis in range(3):
        low = np.abs(shares[:, axis]) <= ROUNDED
        rows = np.concatenate([rows, rows[low]])
        shares = np.concatenate([shares, shares[low] + np.eye(3)[axis]])
    edges = np.array(crystal.cell.orth.mat.tolist())
    elements = [sites[row].element.name for row in rows]
    mesh = joined(elements, (shares @ edges.T).tolist(), name=next(filter(None, words), ""))
    mesh.field_data[CELL] = edges.T
    mesh.point_data["occupancy"] = [sites[row].occ for row in rows]
    return mesh


def _macromolecule(structure: Foreign, path: Path) -> pv.PolyData:
    """Return the atoms of the first model of a structure of gemmi."""
    if len(structure) > 1:
        warn_of_states(path, len(structure))
    rows = [
        (chain.name, residue, atom)
        for chain in structure[0]
        for residue in chain
        for atom in residue
        if atom.altloc in ("\0", "A", "1")
    ]
    elements = [atom.element.name for _, _, atom in rows]
    mesh = joined(elements, [atom.pos.tolist() for _, _, atom in rows])
    mesh.point_data["residue"] = [residue.seqid.num for _, residue, _ in rows]
    mesh.point_data["occupancy"] = [atom.occ for _, _, atom in rows]
    mesh.point_data["b_factor"] = [atom.b_iso for _, _, atom in rows]
    names = [(atom.name, atom.element.name.upper()) for _, _, atom in rows]
    parts = [(ribbons.HELIX, each) for each in structure.helices]
    parts += [(ribbons.STRAND, each) for sheet in structure.sheets for each in sheet.strands]
    ends = [
        (each.start.chain_name, each.start.res_id.seqid.num, each.end.res_id.seqid.num, kind)
        for kind, each in parts
    ]
    residues = [residue.name for _, residue, _ in rows]
    attach_chains(mesh, [name for name, _, _ in rows], names, residues, ends)
    return mesh


def attach_chains(
    mesh: pv.PolyData,
    chains: Sequence[str],
    names: Sequence[tuple[str, str]],
    residues: Sequence[str],
    structure: Sequence[tuple[str, int, int, int]] = (),
) -> None:
    """Attach the numbers of chains and of residues by name, and marks of the atoms of backbones.

    The atoms have ``residue``, and change. ``chains``, ``names`` (with the element) and
    ``residues`` are of each atom; ``structure`` has the chain, first and last residue, and kind of
    each helix and strand of which the file tells.
    """
    every = sorted({*chains})
    number = {name: i for i, name in enumerate(every)}
    of_chain = np.array([number[name] for name in chains], dtype=np.intp)
    mesh.point_data["chain"] = of_chain
    # Lipids have a phosphate too, but no sugar.
    sugars = {residue for residue, (name, _) in zip(residues, names, strict=True) if name in _SUGAR}
    bases = _OF_CHAINS | sugars
    marks = np.array(
        [
            name in _BACKBONE and (name[0] != "P" or residue in bases)
            for residue, name in zip(residues, names, strict=True)
        ],
        dtype=np.uint8,
    )
    places, carbons = np.asarray(mesh.points), np.flatnonzero(marks)
    if len(carbons):
        oxygens = np.flatnonzero([name == ("O", "O") for name in names])
        owners = carbons[np.maximum(np.cumsum(marks)[oxygens].astype(np.intp) - 1, 0)]
        near = np.linalg.norm(places[oxygens] - places[owners], axis=1) < _NEAR
        marks[oxygens[near]] = OXYGEN
    mesh.point_data[BACKBONE] = marks
    said = meaning.of(mesh)
    said.add_kinds("chain", [(i, name.strip(), ()) for i, name in enumerate(every)])
    kinds_of_residues, numbers = np.unique(residues, return_inverse=True)
    mesh.point_data[RESIDUE] = numbers
    said.add_kinds(RESIDUE, [(i, str(name), ()) for i, name in enumerate(kinds_of_residues)])
    if structure and "residue" in mesh.point_data:
        kinds = np.zeros(len(marks), dtype=np.uint8)
        numbers_of_residues = np.asarray(mesh.point_data["residue"])
        rows = {name: np.flatnonzero(of_chain == i) for name, i in number.items()}
        for chain, first, last, kind in structure:
            inside = rows.get(chain, rows[every[0]][:0])
            inside = inside[
                (numbers_of_residues[inside] >= first) & (numbers_of_residues[inside] <= last)
            ]
            kinds[inside] = kind
        mesh.point_data[STRUCTURE] = kinds
        kinds_of_fold = zip(ribbons.NAMES, ribbons.COLORS, strict=True)
        said.add_kinds(STRUCTURE, [(i, *each) for i, each in enumerate(kinds_of_fold)])
    meaning.attach(mesh, said)
    if is_polymer(mesh):
        # Among thousands of atoms elements tell nothing of the fold.
        of_fold = STRUCTURE if np.any(mesh.point_data.get(STRUCTURE, 0)) else "residue"
        mesh.set_active_scalars("chain" if len(every) > 1 else of_fold)


def is_polymer(mesh: pv.DataSet) -> bool:
    """Return whether a mesh is a molecule with long chains of residues."""
    marks, elements = (mesh.point_data.get(name) for name in (BACKBONE, "atom_type"))
    if marks is None or elements is None:
        return False
    of_protein = np.asarray(elements)[marks == 1] == PROTEIN
    return len(of_protein) >= LONG or int(np.count_nonzero(of_protein)) >= FOLDED


def backbone(atoms: pv.PolyData, /) -> pv.PolyData:
    """Return the backbones of the chains of a molecule as closed surfaces, a cartoon of its fold.

    Helices are broad ribbons, strands of sheets arrows, and all else of a protein a thin tube, by
    the records of the file or, without any, by the places of the alpha carbons. Nucleic acids are
    thicker tubes.

    Parameters
    ----------
    atoms : pyvista.PolyData
        Molecule as :func:`vizlight.read` reads it from a PDB or CIF file, which is not changed.

    Returns
    -------
    pyvista.PolyData
        Surfaces along the carbon of each amino acid, or the phosphorus of each nucleotide, with the
        arrays of these atoms, interpolated; helices and strands of which the file tells are kinds
        of faces. They end where the next is farther than in a whole
        chain.

    Raises
    ------
    TypeError, ValueError
        If it is no such molecule.

    Notes
    -----
    Source: Labesse and others, Computer Applications in the Biosciences 13 (1997), for helices and
    strands by places; Carson and Bugg, Journal of Molecular Graphics 4 (1986), for the turn of
    ribbons by the oxygens of peptides.
    """
    _check.instance("atoms", atoms, pv.PolyData, "a pyvista.PolyData")
    needed = "chain", "atom_type"
    for name in (BACKBONE, *needed):
        rows = atoms.point_data.get(name)
        if rows is None or rows.ndim != 1:
            expected = f"a molecule of a PDB or CIF file, with the point array {name!r}"
            raise _check.value_error("atoms", expected, f"arrays {atoms.point_data.keys()}")
    marks = np.asarray(atoms.point_data[BACKBONE])
    marked = np.flatnonzero(marks == 1)
    places = np.asarray(atoms.points, dtype=np.float64)
    oxygens = np.full((len(marked), 3), np.nan)
    of_residue = np.cumsum(marks == 1)[marks == OXYGEN] - 1
    oxygens[of_residue] = places[marks == OXYGEN]
    places = places[marked]
    chains, elements = (np.asarray(atoms.point_data[name])[marked] for name in needed)
    most = np.select([elements == each for each in _APART], list(_APART.values()), 0.0)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    joined = (np.diff(chains) == 0) & (np.diff(elements) == 0) & (steps <= most[:-1])
    # One without neighbours has no curve.
    kept = (np.append(joined, [False]) | np.concatenate([[False], joined]))[: len(marked)]
    if not kept.any():
        return pv.PolyData()
    piece = np.concatenate([[0], np.cumsum(~joined)])[kept]
    marked, places, elements = marked[kept], places[kept], elements[kept]
    said = atoms.point_data.get(STRUCTURE)
    kinds = ribbons.structure(places, piece) if said is None else np.asarray(said)[marked]
    is_protein = elements == PROTEIN
    surface, along = ribbons.swept(
        places,
        ribbons.sides(places, oxygens[kept], piece),
        np.where(is_protein, kinds, ribbons.LOOP),
        piece,
        np.where(is_protein, *_TUBES),
        fine=len(marked) < MANY,
    )
    below = np.minimum(along.astype(np.intp), len(marked) - 1)
    after = np.minimum(below + 1, len(marked) - 1)
    for name, column in atoms.point_data.items():
        rows = np.asarray(column)[marked]
        share = (along - below).reshape(-1, *[1] * (rows.ndim - 1))
        if rows.dtype.kind != "f":
            share = np.rint(share)
        if name != BACKBONE:
            between = (1 - share) * rows[below] + share * rows[after]
            surface.point_data[name] = between.astype(rows.dtype)
    if said is not None:
        # Of faces, so that colours change across a ribbon in a straight line.
        first = along[surface.regular_faces].min(axis=1)
        del surface.point_data[STRUCTURE]
        surface.cell_data[STRUCTURE] = kinds[np.rint(first).astype(np.intp)]
    surface.GetFieldData().ShallowCopy(atoms.GetFieldData())
    return surface


def ligands(atoms: pv.PolyData, /) -> pv.PolyData:
    """Return the atoms and bonds of a molecule that are in none of its chains, without water.

    Parameters
    ----------
    atoms : pyvista.PolyData
        Molecule as :func:`vizlight.read` reads it from a PDB, CIF or GROMACS file, which is not
        changed.

    Returns
    -------
    pyvista.PolyData
        Bonds and atoms with their arrays, of the kinds of residues with the fewest atoms, together
        at most ``MOST_BESIDE``: lipids are as many as water.

    Raises
    ------
    TypeError
        If it is no mesh of atoms.
    """
    _check.instance("atoms", atoms, pv.PolyData, "a pyvista.PolyData")
    counts = beside_chains(atoms)
    total, kept = 0, set[str]()
    for name in sorted(set(counts) - WATERS, key=lambda name: counts[name]):
        total += counts[name]
        if total <= MOST_BESIDE:
            kept.add(name)
    if not kept:
        return pv.PolyData()
    names = meaning.flags(atoms, RESIDUE)
    numbers = [number for number, name in names.items() if name in kept]
    rows = np.flatnonzero(_are_beside(atoms) & np.isin(atoms.point_data[RESIDUE], numbers))
    new = np.full(atoms.n_points, -1)
    new[rows] = np.arange(len(rows))
    pairs = new[np.reshape(atoms.lines, (-1, 3))[:, 1:]]
    pairs = pairs[np.all(pairs >= 0, axis=1)]
    out = _of_pairs(np.asarray(atoms.points)[rows], pairs)
    for name, column in atoms.point_data.items():
        out.point_data[name] = np.asarray(column)[rows]
    out.GetFieldData().ShallowCopy(atoms.GetFieldData())
    return out


def beside_chains(atoms: pv.DataSet) -> dict[str, int]:
    """Return the number of atoms in no chain, those of water too, by the names of residues."""
    names = meaning.flags(atoms, RESIDUE)
    if RESIDUE not in atoms.point_data or not names:
        return {}
    numbers, counts = np.unique(atoms.point_data[RESIDUE][_are_beside(atoms)], return_counts=True)
    return {
        names[number]: count
        for number, count in zip(numbers.tolist(), counts.tolist(), strict=True)
    }


def _are_beside(atoms: pv.DataSet) -> Bools:
    """Return which atoms are in no chain: neither in a residue of one nor in one by its name."""
    names = meaning.flags(atoms, RESIDUE)
    kinds = np.asarray(atoms.point_data[RESIDUE])
    of_chains = [number for number, name in names.items() if name in _OF_CHAINS]
    columns = [atoms.point_data[name] for name in ("chain", "residue") if name in atoms.point_data]
    _, residue = np.unique(np.column_stack([kinds, *columns]), axis=0, return_inverse=True)
    residue = np.ravel(residue)
    # A modified amino acid has a name of its own.
    marked = np.unique(residue[np.asarray(atoms.point_data[BACKBONE]) == 1])
    return np.asarray(~np.isin(kinds, of_chains) & ~np.isin(residue, marked), dtype=np.bool_)


def atoms_in(volume: pv.DataSet, /) -> pv.PolyData:
    """Return the molecule in a volume of a cube file.

    Parameters
    ----------
    volume : pyvista.DataSet
        Volume as :func:`vizlight.read` reads it, with atoms as field arrays.

    Returns
    -------
    pyvista.PolyData
        Bonds and atoms as of :func:`of_xyz`.

    Raises
    ------
    TypeError, ValueError
        If it is no such volume.
    """
    from vtkmodules.vtkDomainsChemistry import vtkPeriodicTable

    _check.instance("volume", volume, pv.DataSet, "a pyvista.DataSet")
    if not {NUMBERS, PLACES} <= {*volume.field_data.keys()}:
        expected = f"the volume of a cube file, with field arrays {NUMBERS!r} and {PLACES!r}"
        raise _check.value_error("volume", expected, f"{volume.field_data.keys()}")
    table = vtkPeriodicTable()
    numbers = np.ravel(volume.field_data[NUMBERS]).tolist()
    places = np.reshape(volume.field_data[PLACES], (-1, 3))
    return joined([table.GetSymbol(int(number)) for number in numbers], places)


def _element(line: str) -> str:
    """Return the element of an atom: of its columns, else by its name."""
    named, name = line[76:78].strip(), line[12:16]
    if named.isalpha():
        return named
    letters = re.sub("[^A-Za-z]", "", name)
    # Two letters begin one column before those of one; four are those of hydrogen.
    is_wide = name[:1].isalpha() and line.startswith("HETATM") and name[3:4] == " "
    return letters[:2] if is_wide and len(letters) > 1 else letters[:1]


def of_xyz(lines: Sequence[str], path: Path) -> pv.PolyData | None:
    """Return the first state of a molecule, its bonds by the distances of its atoms.

    Lines are the number of atoms, a comment, and a symbol and a place for each atom. Bonds, and
    points of atoms without any, have ``atom_type``, the atomic number, and ``radius``, that of van
    der Waals; None is returned where the lines are of another form.
    """
    words = [line.split() for line in lines]
    third = words[2] if len(words) > 2 else []
    if len(words[0]) != 1 or not words[0][0].isdigit() or not third or not _SYMBOL.match(third[0]):
        return None
    count = int(words[0][0])
    atoms = words[2 : 2 + count]
    if len(atoms) < count:
        raise ValueError(f"{len(atoms)} of {count} atoms are there")
    places = []
    for number, atom in enumerate(atoms):
        try:
            places.append([float(word) for word in atom[1:4]])
        except ValueError:
            places.append([])
        if len(places[-1]) < 3 or not np.isfinite(places[-1]).all():
            raise ValueError(f"line {number + 3} has no element with a place of three numbers")
    if len(words) > 2 + count and words[2 + count] == words[0]:
        warn_of_states(path, len(words) // (count + 2))
    mesh = joined([atom[0].rstrip("0123456789") for atom in atoms], places)
    if not mesh.point_data["atom_type"].all():
        number = int(np.argmin(mesh.point_data["atom_type"]))
        raise ValueError(f"line {number + 3} has no element with a place of three numbers")
    return mesh


def joined(
    elements: Sequence[str],
    places: Sequence[Sequence[float]] | Array,
    pairs: Indices | None = None,
    *,
    name: str = "",
) -> pv.PolyData:
    """Return atoms joined by bonds, those of the file or else by their distances.

    Places are in angstroms; anything but an element has the atomic number 0, and a name without a
    letter is none.
    """
    # Few files need what takes 10 ms to load.
    from vtkmodules.vtkDomainsChemistry import vtkPeriodicTable

    if not len(places):
        raise ValueError("it has no atoms")
    table, points = vtkPeriodicTable(), np.asarray(places, dtype=np.float64)
    numbers = {each: table.GetAtomicNumber(each) if each else 0 for each in set(elements)}
    of_atoms = np.array([numbers[each] for each in elements], dtype=np.intp)
    if pairs is None:
        pairs = _bonds(of_atoms, points)
    mesh = _of_pairs(points, pairs)
    mesh.point_data["atom_type"] = of_atoms
    radii = {each: table.GetVDWRadius(numbers[each]) for each in numbers}
    mesh.point_data["radius"] = [radii[each] for each in elements]
    mesh.set_active_scalars("atom_type")
    kinds = []
    for number in sorted({*numbers.values()}):
        color = [0.0, 0.0, 0.0]
        table.GetDefaultRGBTuple(number, color)
        # White and yellow are darker, to be seen on paper.
        light = float(np.dot(formulas.LUMA, color))
        shown = [part * min(1, PALE / light) for part in color]
        shown = [GREYS[number]] * 3 if number in GREYS else shown
        kinds.append((number, table.GetSymbol(number), shown))
    said = meaning.Meaning()
    said.add_array("atom_type", {"long_name": "element"})
    said.add_kinds("atom_type", kinds)
    said.arrays["atom_type"]["long_name"] = "element"
    if re.search("[A-Za-z]", name):
        # In a title VTK takes a bar for the end of a column.
        said.arrays["atom_type"][NAME] = " ".join(name.replace("|", " ").split())
    return meaning.attach(mesh, said)


def _of_pairs(points: Array, pairs: Indices) -> pv.PolyData:
    """Return lines between pairs of points, and points of those that are in none."""
    alone = np.setdiff1d(np.arange(len(points)), pairs)
    verts = np.column_stack([np.ones_like(alone), alone])
    return pv.PolyData(points, lines=np.insert(pairs, 0, 2, axis=1).ravel(), verts=verts)


def _bonds(of_atoms: Indices, points: Array) -> Indices:
    """Return the pairs of atoms that are as near as bonds make them."""
    from vtkmodules.vtkDomainsChemistry import (
        vtkMoleculeToLinesFilter,
        vtkPeriodicTable,
        vtkSimpleBondPerceiver,
    )

    molecule, bonds, drawn = vtkMolecule(), vtkSimpleBondPerceiver(), vtkMoleculeToLinesFilter()
    for number, place in zip(of_atoms.tolist(), points.tolist(), strict=True):
        molecule.AppendAtom(number, *place)
    bonds.SetInputData(molecule)
    drawn.SetInputConnection(bonds.GetOutputPort())
    drawn.Update()
    pairs = np.asarray(pv.wrap(drawn.GetOutput()).lines.reshape(-1, 3)[:, 1:], dtype=np.intp)
    pairs = pairs[~_are_bridged(pairs, of_atoms)]
    no_metal = np.isin(of_atoms, NO_METALS)
    alone = np.setdiff1d(np.arange(len(points)), pairs)
    if np.count_nonzero(no_metal[alone]) <= np.count_nonzero(no_metal) / 2:
        return pairs
    table = vtkPeriodicTable()
    radii = {number: table.GetCovalentRadius(number) for number in {*of_atoms.tolist()}}
    sums = np.array([radii[number] for number in of_atoms.tolist()])[pairs].sum(axis=1)
    lengths = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    # Beads of a coarse model, or one atom of each residue, meet by chance, at any distance.
    usual = np.count_nonzero(np.abs(lengths - sums) < OFF)
    return pairs if usual >= USUAL * len(pairs) else pairs[:0]


def _are_bridged(pairs: Indices, numbers: Indices) -> Bools:
    """Return which bonds are of two metals that are joined to one atom of another element.

    They are cations of an ionic crystal, such as the magnesium of its oxide, and smaller than their
    radii as atoms.
    """
    is_metal = ~np.isin(numbers, NO_METALS)
    between: Bools = np.asarray(is_metal[pairs].all(axis=1))
    if not between.any():
        return between
    ends = pairs[is_metal[pairs].sum(axis=1) == 1]
    ends = np.where(is_metal[ends[:, :1]], ends, ends[:, ::-1])
    size = (len(numbers), len(numbers))
    joined = scipy.sparse.csr_array((np.ones(len(ends), np.intp), tuple(ends.T)), shape=size)
    shared = joined[pairs[:, 0]].multiply(joined[pairs[:, 1]]).sum(axis=1)
    return np.asarray(between & (shared > 0))


def apart(places: Array) -> float:
    """Return the median distance of nearest neighbours among two atoms or more."""
    distances: Array = np.asarray(scipy.spatial.cKDTree(places).query(places, k=2)[0])
    return float(np.median(distances[:, 1]))


def numbers_of(words: Sequence[str] | Sequence[Sequence[str]]) -> Array:
    """Return the numbers in the words of atoms."""
    try:
        return np.array(words, dtype=np.float64)
    except ValueError:
        raise ValueError("an atom has words where its numbers are") from None


def warn_of_states(path: Path, count: int, what: str = "states of a molecule") -> None:
    """Warn that of several states in a file, or several molecules, the first is read."""
    _check.warn(f"file: '{path}': the first of {count} {what} is read")
