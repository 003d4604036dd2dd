"""eomgen derive: the derivation, step by step, with its certificate."""

from __future__ import annotations

from eomgen import pipeline
from eomgen.model.parts import Model
from eomgen.report import rendered
from eomgen.report.derivation import derivation_of
from eomgen.report.payload import equations_payload
from eomgen.verbs.outcome import Outcome


def derive(model: Model, *, method: str, format: str, certify: bool, full: bool = False) -> Outcome:
    """The derivation, and its certificate.

    Args:
        full: everything is printed, however long.
    """
    equations = pipeline.derive(model, method)
    derivation = derivation_of(equations.system, equations.graph, method, full=full)
    certificate = equations.certify() if certify else None
    proof = "" if certificate is None else str(certificate)
    failed = "" if certificate is None or certificate.ok else "the certificate FAILS: do not trust this result"
    if format == "json":
        checks = None if certificate is None else certificate.as_dict()
        return Outcome("", equations_payload(equations, checks, derivation), failed)
    text = rendered(derivation, format)
    return Outcome(_with_proof(text, proof, failed, format), {}, failed)


def _with_proof(text: str, proof: str, failed: str, format: str) -> str:
    """The derivation with its certificate: part of the text, a comment in LaTeX; a failure stands first, visibly."""
    if not proof:
        return text
    text = text.rstrip("\n") + "\n"
    if format == "latex":
        comment = "".join(f"% {line}\n" for line in proof.splitlines())
        visible = r"\begin{document}" + "\n" + r"\textbf{" + failed + "}\n"
        return comment + (text.replace(r"\begin{document}" + "\n", visible, 1) if failed else text)
    if format == "markdown":
        proof = f"```\n{proof}\n```"
        failed = f"**{failed}**" if failed else ""
    return (f"{failed}\n\n" if failed else "") + f"{text}\n{proof}\n"
