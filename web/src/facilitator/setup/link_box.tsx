// A link to copy, with its QR code on request.
import type { JSX } from 'preact';
import { createContext } from 'preact';
import { useContext, useEffect, useId, useRef, useState } from 'preact/hooks';
import type { Api } from '../api';

export const ApiContext = createContext<Api | null>(null);

export function LinkBox({ label, link, withCode }: { label: string; link: string; withCode?: boolean }): JSX.Element {
  const [said, setSaid] = useState('');
  const [shown, setShown] = useState(withCode ?? false);
  const field = useRef<HTMLInputElement>(null);
  const id = useId();
  const copy = async (): Promise<void> => {
    field.current?.select();
    try {
      await navigator.clipboard.writeText(link);
      setSaid('Copied');
    } catch {
      // Without TLS, browsers give pages no clipboard.
      setSaid('Press Ctrl+C to copy');
      field.current?.focus();
    }
  };
  return (
    <div class="link-box">
      <label for={id}>{label}</label>
      <div class="link-row">
        <input id={id} ref={field} type="text" readOnly value={link} onFocus={(event) => event.currentTarget.select()} />
        <button type="button" onClick={copy}>
          Copy<span class="visually-hidden">: {label}</span>
        </button>
        <button type="button" aria-pressed={shown} onClick={() => setShown(!shown)}>
          QR<span class="visually-hidden"> code: {label}</span>
        </button>
        <span class="said" role="status">
          {said}
        </span>
      </div>
      {shown && <QrCode text={link} label={label} />}
    </div>
  );
}

export function QrCode({ text, label }: { text: string; label: string }): JSX.Element {
  const api = useContext(ApiContext);
  const [image, setImage] = useState<string | null>(null);
  const [problem, setProblem] = useState<string | null>(null);
  useEffect(() => {
    let isCurrent = true;
    api?.qr(text).then(
      (address) => isCurrent && setImage(address),
      (error: unknown) => isCurrent && setProblem(error instanceof Error ? error.message : String(error)),
    );
    return () => void (isCurrent = false);
  }, [api, text]);
  if (problem) return <p class="problem">The QR code could not be made: {problem}.</p>;
  return <div class="qr">{image ? <img src={image} alt={`QR code: ${label}`} width={180} height={180} /> : <span class="hint">Making the QR code...</span>}</div>;
}
