from typing import Any
def make_report(study: Any, manifest: Any, sessions: Any) -> Any:
    raise NotImplementedError
