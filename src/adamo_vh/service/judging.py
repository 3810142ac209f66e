"""What a judge is told by a server, for those who ask from elsewhere."""

from __future__ import annotations

from adamo_vh.action_server.lines import refused
from adamo_vh.episode.result import EpisodeResult, result_from
from adamo_vh.errors import ConfigError, EngineError
from adamo_vh.serving.loopback import is_loopback


def fetch_result(url: str, session: str, token: str, timeout_s: float = 60.0) -> EpisodeResult:
    """The result of a session.

    Args:
        url: Of the server.
        session: Its id.
        token: The judge's.
        timeout_s: For the answer to come, seconds.

    Raises:
        ConfigError: The token is no judge's, or the episode has not ended.
        EngineError: The server cannot be reached.
        RecordError: It is of another version.
    """
    import httpx

    on_loopback = is_loopback(httpx.URL(url).host)
    headers = {"authorization": f"Bearer {token}"}
    try:
        with httpx.Client(timeout=timeout_s, trust_env=not on_loopback, headers=headers) as client:
            answer = client.get(f"{url.rstrip('/')}/v1/sessions/{session}/result")
    except (httpx.TransportError, httpx.InvalidURL) as error:
        raise EngineError(f"The server cannot be reached: {error}.") from None
    if not answer.is_success:
        said = refused(answer.status_code, answer.content)
        raise said if isinstance(said, ConfigError) else EngineError(str(said))
    return result_from(answer.content, url)
