"""``robot-bridge tls``: a certificate authority for the site, and the gateway's certificate."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..gateway.auth import certificates

app = typer.Typer(help="Certificates for wss://.", no_args_is_help=True)

Folder = Annotated[Path, typer.Argument(help="Folder of the certificates.")]
Days = Annotated[int, typer.Option(help="Days that the gateway's certificate holds.", min=1, max=3650)]


@app.command()
def create(
    folder: Folder,
    name: Annotated[
        list[str] | None, typer.Option(help="Host name by which it is reached; may be repeated.")
    ] = None,
    ip: Annotated[
        list[str] | None, typer.Option(help="IP address by which it is reached; may be repeated.")
    ] = None,
    days: Days = certificates.SERVER_DAYS,
) -> None:
    """Make a certificate authority for this site and the gateway's certificate under it."""
    files = certificates.create(folder, name or [], ip or [], days)
    typer.echo(f"{files.ca}: for every robot (--ca) and every desk; no secret")
    typer.echo(f"{files.ca_key}: keep it off the network; whoever has it can pose as the gateway")
    typer.echo(f"start with: serve --certificate {files.certificate} --key {files.key}")
    typer.echo(f"holds until {certificates.valid_until(files.certificate):%Y-%m-%d}")


@app.command()
def renew(folder: Folder, days: Days = certificates.SERVER_DAYS) -> None:
    """Give the gateway a new key and certificate; a running one takes them by itself within seconds."""
    until = certificates.renew(folder, days)
    typer.echo(f"{certificates.TlsFiles(folder).certificate}: holds until {until:%Y-%m-%d}")
