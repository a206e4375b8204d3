"""Readers of measured rubber and of its models."""

from __future__ import annotations

from pathlib import Path

from damaged.mutations import Reader, zip_changed
from measured import DATA

XLS = DATA / "formats" / "eplexor.xls"


def material() -> Reader:
    import bearingdyn as bd

    rubber = bd.Maxwell(1e6, [2e6, 1e6], [1e-3, 1e-2], K=2e9, density=1200.0)

    def write(folder: Path) -> None:
        (folder / "m.json").write_text(rubber.to_json())

    def read(folder: Path) -> None:
        bd.Maxwell.from_json((folder / "m.json").read_text(encoding="utf-8"))

    return Reader(write, read, names_file=False)


def dma() -> Reader:
    import bearingdyn as bd

    rows = "".join(
        f"{T},{f},{2e6 * (1 + f / 50 - T / 200):.4e},{3e5 * (1 + f / 100):.4e}\n"
        for T in (-10, 0, 10, 20)
        for f in (1.0, 3.0, 10.0, 30.0)
    )

    def write(folder: Path) -> None:
        head = "temperature_C,frequency_Hz,G_storage_Pa,G_loss_Pa\n"
        (folder / "d.csv").write_text(head + rows)

    return Reader(write, lambda f: bd.read_dma(f / "d.csv"))


def dma_kinds() -> Reader:
    """Every kind of file that tests/fuzz_dma.py has a sound one of, each read as that file asks for."""
    import bearingdyn as bd
    from fuzz_dma import seeds

    files = [(f"seed{k}{ending}", content) for k, (ending, content) in enumerate(seeds())]

    def write(folder: Path) -> None:
        for name, content in files:
            (folder / name).write_bytes(content)

    def read(folder: Path) -> None:
        for name, content in files:
            bd.read_dma(folder / name, mode="shear" if b"tan" not in content else None)

    return Reader(write, read)


def xlsx() -> Reader:
    import openpyxl

    import bearingdyn as bd

    def write(folder: Path) -> None:
        book = openpyxl.Workbook()
        book.active.append(["frequency_Hz", "temperature_C", "G_storage_Pa", "G_loss_Pa"])
        for T in (20.0, 40.0):
            for f in (0.1, 0.3, 1.0, 3.0, 10.0):
                book.active.append([f, T, 5e6 * f**0.1 - 1e4 * T, 1e6 * f**0.1])
        book.save(folder / "d.xlsx")

    return Reader(write, lambda f: bd.read_dma(f / "d.xlsx"), zip_changed)


def xls() -> Reader:
    import bearingdyn as bd

    def write(folder: Path) -> None:
        (folder / "d.xls").write_bytes(XLS.read_bytes())

    return Reader(write, lambda f: bd.read_dma(f / "d.xls"))


def strain_sweep() -> Reader:
    import bearingdyn as bd

    rows = "".join(
        f"{g:g},{4e6 / (1 + g / 5):.4e},{6e5 / (1 + g / 9):.4e},10\n" for g in (0.1, 0.3, 1.0, 3.0, 10.0)
    )

    def write(folder: Path) -> None:
        head = "strain (%),storage modulus (Pa),loss modulus (Pa),frequency (Hz)\n"
        (folder / "s.csv").write_text(head + rows)

    return Reader(write, lambda f: bd.read_strain_sweep(f / "s.csv", mode="shear", temperature=20.0))
