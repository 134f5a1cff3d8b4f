// The text that somebody agrees to. The choice stands below it, so that nobody passes by the text.
import type { JSX } from 'preact';
import { useState } from 'preact/hooks';
import { download } from '../../shared/download';
import { Button, Heading, Paragraphs } from '../parts/ui';
import type { ScreenProps } from '../screen';
import { recall } from '../storage';
import type { Stores } from '../../shared/stores';
import { listed, t } from '../../shared/texts';
import { transport } from '../../shared/transport';

type Shown = NonNullable<ScreenProps['view']['consent']>;

export function Consent({ consent, view, connection }: ScreenProps & { consent: Shown }): JSX.Element {
  const [agrees, setAgrees] = useState(false);
  const [isMissing, setMissing] = useState(false);
  const [declines, setDeclines] = useState(false);
  const off = connection.isPending('consent');
  const { version } = consent;
  if (transport().isAlone) return <Start off={off} onStart={() => connection.send('consent', { accept: true, version })} />;
  const paragraphs = [...consent.paragraphs, ...(transport().isLocal ? transport().notices() : whatIsStored(consent.stores))];
  const agree = (): void => {
    setMissing(!agrees);
    if (agrees) connection.send('consent', { accept: true, version, query: recall<Record<string, string>>('query') ?? {} });
  };
  return (
    <>
      <Heading>{t('consent.title')}</Heading>
      <div class="consent-text">
        <Paragraphs texts={paragraphs} />
        <p class="muted">{t('consent.version', { version })}</p>
        <Button onClick={() => saveText(view.study.title, [...paragraphs, t('consent.version', { version })])}>
          {t('consent.copy')}
        </Button>
      </div>
      <div class="choice">
        <label class="tick">
          <input
            type="checkbox"
            checked={agrees}
            aria-describedby="consent-missing"
            onChange={(event) => {
              setAgrees(event.currentTarget.checked);
              setMissing(false);
            }}
          />
          <span>{t('consent.choice')}</span>
        </label>
        <p id="consent-missing" role="alert" class="error">
          {isMissing && t('consent.unchecked')}
        </p>
        <div class="buttons">
          <Button primary off={off} onClick={agree}>
            {t('consent.agree')}
          </Button>
          <Button off={off || declines} onClick={() => setDeclines(true)}>
            {t('consent.decline')}
          </Button>
        </div>
        {declines && (
          <div class="sure">
            <p role="status">{t('consent.sure')}</p>
            <div class="buttons">
              <Button primary off={off} onClick={() => setDeclines(false)}>
                {t('consent.sure_no')}
              </Button>
              <Button off={off} onClick={() => connection.send('consent', { accept: false, version })}>
                {t('consent.sure_yes')}
              </Button>
            </div>
          </div>
        )}
      </div>
    </>
  );
}

// Who is told something agrees to that.
function Start({ off, onStart }: { off: boolean; onStart: () => void }): JSX.Element {
  const notices = transport().notices();
  return (
    <>
      <Heading>{t('predict.title')}</Heading>
      <Paragraphs texts={notices} />
      <Button primary off={off} onClick={onStart}>
        {t(notices.length > 1 ? 'consent.agree' : 'consent.start')}
      </Button>
    </>
  );
}

// What the server keeps of whoever takes part.
function whatIsStored(stores?: Stores): string[] {
  if (!stores) return [];
  const kept = [
    t('stored.answers'),
    t(stores.names ? 'stored.names' : 'stored.no_names'),
    stores.query.length > 0 && t('stored.query', { names: listed(stores.query) }),
    stores.screening && t('stored.screening'),
    stores.questions && t('stored.questions'),
    stores.discussion && t('stored.discussion'),
    t('stored.not'),
    t('stored.kept'),
  ];
  return [`# ${t('stored.title')}`, ...kept.filter((text) => text !== false).map((text) => `* ${text}`)];
}

// The reader's own copy, as a text file.
function saveText(title: string, paragraphs: string[]): void {
  const text = `${[title, ...paragraphs].join('\n\n')}\n`;
  download(new Blob([text], { type: 'text/plain;charset=utf-8' }), 'consent.txt');
}
